// The moray: dark patches that crowd each other, parted by a net of pale lines, finer towards the head.
#include "fish/skin.glsl"
#include "fish/cells.glsl"
#include "lib/noise.glsl"

const vec3 IRIS = vec3(0.70, 0.58, 0.24);
const int PATCHES = 13;           // around the body
const float FIN_SLANT = 0.0;

vec3 coat(Spot spot) {
    if (!FINE)          // too small for patches: their mean
        return mix(u_ground_color, u_pattern_color, 0.6);
    float wander = perlin_noise(vec3(18.0, 24.0, 24.0) * spot.rest);
    vec2 away = cell_distances(float(PATCHES) * spot.lattice + 0.22 * wander, PATCHES);
    float inside = away.y - away.x - 0.14, width = max(0.08, float(PATCHES) * spot.pixel / u_girth);
    vec3 dark = u_pattern_color * (1.0 + 0.5 * wander) * (1.0 - 0.3 * smoothstep(0.0, 0.5, away.x));
    vec3 color = mix(u_ground_color * (1.0 + 0.12 * wander), dark, smoothstep(-width, width, inside));
    return color * mix(vec3(1.15, 1.12, 1.0), vec3(0.85), smoothstep(-0.8, 0.9, spot.back));
}

Skin body_skin(Spot spot, vec3 color) {
    return Skin(color, 1.5, 0.30, 0.15, 0.0);
}

Fin fin_skin(Spot spot, int part, vec2 place, vec3 color) {
    return Fin(mix(color, u_ground_color * 1.2, smoothstep(0.82, 0.92, place.y)), mix(1.0, 0.86, place.y));
}
