#version 330 core
// A line, its edges softened over a pixel.
#include "lib/color.glsl"

in float v_across;
flat in float v_half_width;
flat in vec3 v_color;

out vec4 out_color;

void main() {
    out_color = vec4(linear_light(v_color), clamp(v_half_width - abs(v_across) + 0.5, 0.0, 1.0));
}
