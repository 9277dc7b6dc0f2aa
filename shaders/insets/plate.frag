#version 330 core
// A dark card with rounded corners; a little of what is behind it shines through.
#include "lib/frame.glsl"
#include "lib/color.glsl"

uniform vec4 u_plate;
uniform float u_opacity;

in vec2 v_place;

out vec4 out_color;

void main() {
    vec2 size = 0.5 * (u_plate.zw - u_plate.xy) * u_frame.resolution;
    float corner = 0.012 * u_frame.resolution.y;
    vec2 beyond = max(abs(v_place - 0.5) * size - (0.5 * size - corner), 0.0);
    float inside = clamp(corner - length(beyond) + 0.5, 0.0, 1.0);
    vec3 card = linear_light(mix(vec3(0.085, 0.094, 0.11), vec3(0.125, 0.137, 0.16), v_place.y));
    out_color = vec4(card, u_opacity * inside);
}
