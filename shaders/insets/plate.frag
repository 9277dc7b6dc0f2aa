#version 330 core
// A card of light paper with rounded corners.
#include "lib/frame.glsl"
#include "lib/color.glsl"

uniform vec4 u_plate;

in vec2 v_place;

out vec4 out_color;

void main() {
    vec2 size = 0.5 * (u_plate.zw - u_plate.xy) * u_frame.resolution;
    float corner = 0.012 * u_frame.resolution.y;
    vec2 beyond = max(abs(v_place - 0.5) * size - (0.5 * size - corner), 0.0);
    float inside = clamp(corner - length(beyond) + 0.5, 0.0, 1.0);
    vec3 paper = linear_light(mix(vec3(0.925, 0.92, 0.905), vec3(0.96, 0.957, 0.945), v_place.y));
    out_color = vec4(0.93 * paper, inside);
}
