// Under water: the colour of the water itself, how it veils what is far, and the light that reaches down into it.
// vec3 water_color(vec3 direction): what one sees that looks into it this way, linear light.
// float veil(vec3 position): how much of what is there the water hides; vec3 veiled(vec3 color, vec3 position): what
// the eye gets of a surface's light.
// vec3 underwater_light(vec3 position, vec3 normal, Finish finish): light to the eye, not yet veiled.
// vec3 plain_underwater_light(vec3 normal): the same for a white surface without shadow, caustics and what is mirrored.
#include "lib/lighting.glsl"
#include "lib/caustics.glsl"

// What a surface is made of.
struct Finish {
    vec3 albedo;        // its colour by scattered light
    vec3 mirror;        // how strongly it mirrors: 1 is wet skin, more is silver
    float roughness;
    float passing;      // how much of the light on its other side comes through, 0 to 1
};

const vec3 SUN = vec3(3.3, 3.25, 2.95);
const float SNELL = 0.66;           // how steeply up one looks to see the sky through still water: cos 48.6 degrees
const vec3 FROM_SAND = vec3(0.42, 0.42, 0.34);

vec3 water_color(vec3 direction) {
    float up = smoothstep(-0.30, 0.62, direction.y);
    vec3 water = mix(u_frame.backdrop_low.rgb, u_frame.backdrop_high.rgb, up * up);
    water *= 1.0 - 0.65 * (1.0 - u_frame.has_ground) * smoothstep(0.0, 0.8, -direction.y);     // nothing below but dark
    float towards_sun = max(dot(direction, u_frame.key_direction), 0.0);
    return water * (1.0 + 0.5 * towards_sun * towards_sun);
}

// The water between the eye and the middle of the scene is left clear, from wherever one looks at it.
float veil(vec3 position) {
    float clear = length(u_frame.eye - u_frame.center);
    float through = max(length(position - u_frame.eye) - clear, 0.0) / u_frame.radius;
    return 1.0 - exp(-0.16 * through);
}

vec3 veiled(vec3 color, vec3 position) {
    return mix(color, water_color(normalize(position - u_frame.eye)), veil(position));
}

// The light from all around: from the sand below, if there is any, and from the bright water above.
vec3 light_around(vec3 normal) {
    vec3 below = 0.35 * u_frame.backdrop_low.rgb + 0.30 * u_frame.has_ground * FROM_SAND;
    return mix(below, 0.30 + 0.75 * u_frame.backdrop_high.rgb, 0.5 + 0.5 * normal.y);
}

vec3 plain_underwater_light(vec3 normal) {
    return light_around(normal) + max(dot(normal, u_frame.key_direction), 0.0) * SUN / PI;
}

vec3 underwater_light(vec3 position, vec3 normal, Finish finish) {
    vec3 to_eye = normalize(u_frame.eye - position);
    vec3 light = finish.albedo * light_around(normal);

    float facing = dot(normal, u_frame.key_direction);
    float reaching = key_light_on_surface(position, facing > 0.0 ? normal : -normal);
    vec3 sun = SUN * reaching * mix(1.0, caustic_light(position), 0.75);
    light += sun * (max(facing, 0.0) + finish.passing * max(-facing, 0.0)) * finish.albedo / PI;
    float mirrored = glossy_reflection(normal, u_frame.key_direction, to_eye, finish.roughness);
    light += sun * max(facing, 0.0) * mirrored * finish.mirror;

    // The water mirrored, more so at grazing angles: the rim of light.
    float grazing = 1.0 - max(dot(normal, to_eye), 0.15);       // at an edge the eye sees a band, never all of it
    float fresnel = 0.04 + 0.96 * grazing * grazing * grazing * grazing;
    vec3 way = reflect(-to_eye, normal);
    float window = smoothstep(SNELL - finish.roughness, SNELL + finish.roughness, way.y);
    vec3 mirrored_water = 0.8 * water_color(way) + 1.6 * window * u_frame.backdrop_high.rgb;
    light += min(finish.mirror * fresnel, vec3(1.0)) * mirrored_water;
    return light;
}
