// The tuna: a blue-black back over silver flanks, all of it mirror; yellow second fins and finlets.
#include "fish/skin.glsl"
#include "lib/noise.glsl"

const vec3 IRIS = vec3(0.42, 0.42, 0.36);
const vec3 SILVER = vec3(0.46, 0.51, 0.54);
const vec3 PALE = vec3(0.80, 0.82, 0.80);
const float FIN_SLANT = 0.0;

float darkness(float height) {
    return smoothstep(0.02, 0.40, height);
}

vec3 coat(Spot spot) {
    float wander = FINE ? perlin_noise(vec3(6.0 * spot.rest.x, 13.0 * spot.rest.y, 3.0 + pattern_start())) : 0.0;
    float height = spot.back + 0.12 * wander;
    float gleam = smoothstep(-0.02, 0.16, height) * (1.0 - smoothstep(0.22, 0.50, height));     // along the border
    float belly = 1.0 - smoothstep(-0.85, -0.15, height);
    vec3 color = mix(mix(SILVER, PALE, belly), u_ground_color, darkness(height));
    // Broken bars of paler silver low on the flank.
    float bars = smoothstep(0.25, 0.8, cos(110.0 * spot.along + 5.0 * wander)) * smoothstep(0.3, 0.55, spot.along);
    color += 0.09 * bars * (1.0 - darkness(height)) * (1.0 - belly);
    return color + gleam * vec3(0.01, 0.07, 0.20);
}

Skin body_skin(Spot spot, vec3 color) {
    float dark = darkness(spot.back), belly = 1.0 - smoothstep(-0.85, -0.15, spot.back);
    return Skin(color, mix(mix(7.5, 3.0, belly), 0.55, dark), mix(0.36, 0.42, dark), mix(1.0, 0.12, dark), 0.10);
}

Fin fin_skin(Spot spot, int part, vec2 place, vec3 color) {
    vec3 dark = mix(u_ground_color, vec3(0.05, 0.06, 0.08), 0.6);
    bool yellow = (part == DORSAL || part == ANAL) && spot.along > 0.50;
    color = yellow ? u_pattern_color * mix(0.75, 1.0, place.y) : dark;
    if (part == PECTORAL || part == PELVIC)
        color = mix(dark, vec3(0.18, 0.20, 0.22), 0.5);
    return Fin(color, yellow ? 0.97 : 0.94);
}
