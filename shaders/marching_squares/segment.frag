#version 330 core
// A line with round ends and soft borders.
#include "lib/color.glsl"

uniform vec3 u_line_color;        // sRGB

in vec2 v_from_start;
flat in float v_length;
flat in float v_half_width;

out vec4 out_color;

void main() {
    vec2 away = vec2(v_from_start.x - clamp(v_from_start.x, 0.0, v_length), v_from_start.y);
    out_color = vec4(linear_light(u_line_color), clamp(0.5 + v_half_width - length(away), 0.0, 1.0));
}
