// How much of the key light reaches a place, from blurred moments of the light's depth:
// variance shadow maps, Donnelly and Lauritzen 2006. One look-up, an edge without steps.
// float key_light_on_surface(vec3 position, vec3 normal): 0 in shadow to 1 lit.
// float key_light_on_floor(vec3 position): the same with an edge that softens away from what casts it.
#include "lib/frame.glsl"

uniform sampler2D u_shadow_near;   // mean depth and mean squared depth, blurred a little
uniform sampler2D u_shadow_wide;   // and blurred widely

// The share of the light that passes, at most, among depths with these moments (Chebyshev).
float share_lit(vec2 moments, float depth) {
    float variance = max(moments.y - moments.x * moments.x, 2e-5);
    float behind = depth - moments.x;
    return behind <= 0.0 ? 1.0 : variance / (variance + behind * behind);
}

// How far a place lies beyond the shadow map, where nothing casts a shadow: 0 inside to 1 outside.
float beyond_shadow(vec2 place) {
    vec2 from_middle = abs(place - 0.5);
    return smoothstep(0.44, 0.48, max(from_middle.x, from_middle.y));
}

float key_light_on_surface(vec3 position, vec3 normal) {
    vec3 place = (u_frame.world_to_shadow * vec4(position + 0.01 * u_frame.radius * normal, 1.0)).xyz;
    float lit = share_lit(texture(u_shadow_near, place.xy).rg, place.z);
    lit = clamp((lit - 0.15) / 0.85, 0.0, 1.0);        // light that leaks where shadows overlap
    return mix(lit, 1.0, beyond_shadow(place.xy));
}

float key_light_on_floor(vec3 position) {
    vec3 place = (u_frame.world_to_shadow * vec4(position, 1.0)).xyz;
    float outside = beyond_shadow(place.xy);
    if (outside == 1.0)
        return 1.0;
    vec2 wide = texture(u_shadow_wide, place.xy).rg;
    float height = clamp(2.2 * (place.z - wide.x), 0.0, 1.0);
    float sharp_edge = share_lit(texture(u_shadow_near, place.xy).rg, place.z);
    return mix(mix(sharp_edge, share_lit(wide, place.z), 0.25 + 0.75 * height), 1.0, outside);
}
