#version 330 core
// Both finite differences at one epsilon, to be captured and compared with the truth.
#include "rippling_sphere/ripple.glsl"

uniform float u_probe_epsilon;

in vec3 in_position;

out vec3 v_forward;
out vec3 v_central;

void main() {
    v_forward = ripple_normal(in_position, FORWARD, u_probe_epsilon);
    v_central = ripple_normal(in_position, CENTRAL, u_probe_epsilon);
    gl_Position = vec4(0.0);
}
