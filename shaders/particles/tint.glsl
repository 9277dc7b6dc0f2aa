// A particle's colour: by its age and its own chance, or telling of something, and in the light where it is.
// vec4 tint(vec3 place, vec3 normal, Qualities of, float opacity, out float reaching): linear light where it is
// opaque, and its opacity; `reaching` is how much of the key light reaches it.
// vec4 over_life(float over, int row): from viewer/engine/particles/life_table.py.
#include "lib/color.glsl"
#include "lib/lighting.glsl"

uniform sampler2D u_table;
uniform float u_glow;
uniform float u_lighting;
uniform vec2 u_hue;                 // degrees
uniform vec2 u_brightness;
uniform vec2 u_colouring_range;

const float BRIGHTEST = 30000.0;    // half floats hold twice as much

struct Qualities {
    uint identity;
    int generation;
    float over;                     // how much of its life is over, 0 to 1
    float speed, mass, size;
    float diameter;                 // its size as it now is
};

vec4 over_life(float over, int row) {
    int last = textureSize(u_table, 0).x - 1;
    float place = clamp(over, 0.0, 1.0) * float(last);
    int step = min(int(place), last - 1);
    vec4 before = texelFetch(u_table, ivec2(step, row), 0), after = texelFetch(u_table, ivec2(step + 1, row), 0);
    return mix(before, after, place - float(step));
}

// Turned about the axis of greys, by Rodrigues' formula.
vec3 with_hue(vec3 color, float angle) {
    float grey = dot(color, vec3(1.0 / 3.0));
    vec3 across = (color.zxy - color.yzx) * 0.57735027;
    return max(vec3(grey) + (color - grey) * cos(angle) + across * sin(angle), 0.0);
}

vec3 own_color(Qualities of) {
    vec3 color = over_life(of.over, 1 + clamp(of.generation, 0, 3)).rgb;
    if (u_hue != vec2(0.0))
        color = with_hue(color, radians(mix(u_hue.x, u_hue.y, random_of(of.identity, 61u))));
    return color * mix(u_brightness.x, u_brightness.y, random_of(of.identity, 62u));
}

vec3 telling_color(Qualities of) {
    if (COLOURING == BY_GENERATION)
        return okabe_ito(1 + of.generation);
    float value = COLOURING == BY_AGE ? of.over : COLOURING == BY_SPEED ? of.speed :
                  COLOURING == BY_MASS ? of.mass : of.size;
    return viridis((value - u_colouring_range.x) / (u_colouring_range.y - u_colouring_range.x));
}

// Light that comes from a flat, thin thing: part of it shines through from behind. What is round and translucent,
// with no side of its own, scatters as much whichever way it is lit.
vec3 light_on(vec3 place, vec3 normal, float reaching) {
    float facing = 0.7, height = 0.5;
    if (BILLBOARD == TUMBLES) {
        vec3 towards_eye = dot(normal, u_frame.eye - place) < 0.0 ? -normal : normal;
        float lit = dot(towards_eye, u_frame.key_direction);
        facing = lit > 0.0 ? lit : -0.55 * lit;
        height = 0.5 + 0.5 * towards_eye.y;
    }
    return mix(FLOOR_LIGHT, SKY_LIGHT, height) + 0.4 * FILL_LIGHT + KEY_LIGHT / PI * facing * reaching;
}

vec4 tint(vec3 place, vec3 normal, Qualities of, float opacity, out float reaching) {
    reaching = 1.0;
    opacity = clamp(opacity, 0.0, 1.0);
    if (COLOURING != BY_LOOK)
        return vec4(telling_color(of), opacity);
    vec3 color = own_color(of);
    if (LIT) {
        reaching = key_light_on_surface(place + 0.5 * of.diameter * u_frame.key_direction, u_frame.key_direction);
        if (SPRITE != BALL && SPRITE != PUFF)       // those are lit pixel by pixel
            color *= mix(vec3(1.0), light_on(place, normal, reaching), u_lighting);
    }
    return vec4(min(u_glow * color, BRIGHTEST), opacity);
}
