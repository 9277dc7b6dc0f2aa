#version 330 core
// The light that a speck of dust scatters.
#include "lib/frame.glsl"

in vec2 v_place;
in float v_light;

out vec4 out_light;

void main() {
    float inside = max(1.0 - dot(v_place, v_place), 0.0);
    out_light = vec4(0.55 * v_light * inside * inside * u_frame.backdrop_high.rgb, 0.0);
}
