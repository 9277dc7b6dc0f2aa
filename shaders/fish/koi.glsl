// The koi: white, with clouds of red and black that drift over its back, and a net of scales.
#include "fish/skin.glsl"
#include "lib/noise.glsl"

const vec3 IRIS = vec3(0.30, 0.24, 0.16);
const vec3 INK = vec3(0.012, 0.013, 0.018);
const float FIN_SLANT = 0.0;

// Noise whose own domain is bent by noise, so that the edges of clouds curl: how far inside the red ones, and the
// black.
vec2 clouds(vec3 rest) {
    vec3 start = vec3(0.0, 0.0, 1.37 * pattern_start());
    if (!FINE) {        // too small for curls
        vec3 place = vec3(15.0, 18.0, 18.0) * rest + 2.3 * start.z;
        return 0.6 * vec2(sin(place.x + sin(place.z)), sin(2.3 * place.x + place.z + 1.7) - 0.3);
    }
    vec3 bend = perlin_noise_gradient(6.5 * rest + start.zxy).xyz;
    float red = perlin_noise(vec3(4.2, 5.2, 5.2) * rest + 0.25 * bend + start);
    float black = perlin_noise(vec3(6.0, 8.0, 8.0) * rest - 0.30 * bend.zxy + start + 7.7);
    return vec2(red, black);
}

vec3 coat(Spot spot) {
    float high = smoothstep(-0.62, 0.35, spot.back);
    vec2 inside = clouds(spot.rest) - mix(vec2(0.55, 0.70), vec2(-0.06, 0.30), high);
    vec3 color = u_ground_color * mix(vec3(1.0, 0.95, 0.86), vec3(1.0), smoothstep(-0.9, 0.2, spot.back));
    vec3 red = u_pattern_color * mix(vec3(1.25, 1.9, 1.6), vec3(1.0), smoothstep(0.0, 0.22, inside.x));
    color = mix(color, red, beyond(inside.x, 0.018, spot));
    return mix(color, INK, 0.96 * beyond(inside.y, 0.022, spot));
}

Skin body_skin(Spot spot, vec3 color) {
    return Skin(color, 1.2, 0.28, 0.35, 0.62);
}

Fin fin_skin(Spot spot, int part, vec2 place, vec3 color) {
    vec3 clear = mix(u_ground_color, vec3(0.86, 0.90, 0.92), place.y);
    float stain = max(1.0 - 1.6 * place.y, 0.0) * (1.0 - smoothstep(0.02, 0.20, color.g));
    return Fin(mix(clear, color, stain), mix(0.92, 0.58, place.y));
}
