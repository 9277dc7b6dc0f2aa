// How much of the key light reaches a place.
// float key_light_reaching(vec3 position, vec3 normal, float blur): 0 in shadow to 1 lit;
// blur is the radius, in the world, over which the shadow's edge is softened.
#include "lib/frame.glsl"

uniform sampler2DShadow u_shadow_map;

const int SHADOW_TAPS = 8;
const float GOLDEN_ANGLE = 2.39996323;

float key_light_reaching(vec3 position, vec3 normal, float blur) {
    float texel = u_shadow_width / float(textureSize(u_shadow_map, 0).x);
    float slope = 1.0 - max(dot(normal, u_key_direction), 0.0);
    vec3 lifted = position + normal * (1.5 * texel + blur * slope);
    vec3 place = (u_world_to_shadow * vec4(lifted, 1.0)).xyz;
    if (any(lessThan(place.xy, vec2(0.0))) || any(greaterThan(place.xy, vec2(1.0))))
        return 1.0;                                     // beyond the map nothing casts a shadow
    place.z = min(place.z, 1.0);
    float radius = blur / u_shadow_width;
    float lit = 0.0;
    for (int tap = 0; tap < SHADOW_TAPS; ++tap) {       // a spiral of samples, evenly spread (Vogel 1979)
        float along = sqrt((float(tap) + 0.5) / float(SHADOW_TAPS));
        float angle = float(tap) * GOLDEN_ANGLE;
        vec2 offset = radius * along * vec2(cos(angle), sin(angle));
        lit += texture(u_shadow_map, vec3(place.xy + offset, place.z));
    }
    return lit / float(SHADOW_TAPS);
}
