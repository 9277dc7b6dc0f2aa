#version 330 core
// The floor takes its colour from the backdrop, so that no horizon shows; only light and shadow tell it.
#include "lib/backdrop.glsl"
#include "lib/shadow.glsl"

in vec3 v_position;

out vec4 out_color;

void main() {
    vec3 wall = backdrop(gl_FragCoord.xy);
    float distance_out = length(v_position.xz - u_frame.center.xz) / u_frame.radius;
    float presence = 1.0 - smoothstep(1.0, 6.0, distance_out);
    float reaching = key_light_on_floor(v_position);
    vec3 below = vec3(u_frame.center.x, u_frame.ground_height, u_frame.center.z);
    float nearness = 1.0 - smoothstep(0.0, 1.6, length(v_position - below) / u_frame.radius);
    float light = mix(0.30, 1.0, reaching) * (1.0 - 0.25 * nearness);
    out_color = vec4(wall * mix(1.0, 1.12 * light, presence), 1.0);
}
