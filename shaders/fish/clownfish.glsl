// The clownfish: orange, with three white bars that are edged in black, and black and white rims on its fins.
#include "fish/skin.glsl"
#include "lib/noise.glsl"

const vec3 IRIS = vec3(0.55, 0.22, 0.05);
const vec3 EDGE = vec3(0.012, 0.010, 0.010);
const float FIN_SLANT = 0.12;     // how far the pattern of a fin leans back, in body lengths out to its tip

// How far outside the nearest of the bars, in body lengths; the bars lean with the body's curve.
float outside_bars(Spot spot, float wander) {
    float flank = 1.0 - spot.back * spot.back;
    float along = spot.along + 0.008 * wander;
    float head = abs(along - 0.235 - 0.022 * flank + 0.022 * spot.back) - 0.029 - 0.006 * flank;
    float middle = abs(along - 0.475 + 0.035 * flank * flank) - 0.036 - 0.022 * flank * flank;
    float stalk = abs(along - 0.795 - 0.01 * flank) - 0.021;
    return min(head, min(middle, stalk));
}

vec3 coat(Spot spot) {
    float cloudy = FINE ? perlin_noise(11.0 * spot.rest + pattern_start()) : 0.0;
    float shade = smoothstep(-0.9, 1.0, spot.back + 0.35 * cloudy);
    vec3 color = u_ground_color * mix(vec3(1.12, 1.50, 2.0), vec3(0.74, 0.50, 0.42), shade);
    float outside = outside_bars(spot, cloudy);
    color = mix(EDGE, color, beyond(outside - 0.011, 0.0025, spot));
    return mix(u_pattern_color, color, beyond(outside, 0.0018, spot));
}

Skin body_skin(Spot spot, vec3 color) {
    return Skin(color, 1.1, 0.34, 0.25, 0.75);
}

Fin fin_skin(Spot spot, int part, vec2 place, vec3 color) {
    if (part != DORSAL)
        color = u_ground_color;
    color *= mix(vec3(1.0), vec3(1.1, 1.4, 1.3), place.y);
    float rim = place.y + 0.10 * (abs(2.0 * place.x - 1.0) - 0.6);
    color = mix(color, EDGE, smoothstep(0.72, 0.80, rim));
    color = mix(color, u_pattern_color, 0.9 * smoothstep(0.93, 0.97, rim));
    return Fin(color, mix(0.96, 0.80, place.y));
}
