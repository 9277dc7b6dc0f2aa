#version 330 core
// Each vertex of the sphere is moved, and given the normal that the parameter `normals` asks for.
#include "rippling_sphere/ripple.glsl"

uniform int u_normals;
uniform float u_epsilon;

in vec3 in_position;

out vec3 v_position;
out vec3 v_normal;
out vec3 v_exact_normal;

void main() {
    v_position = rippled(in_position);
    v_normal = ripple_normal(in_position, u_normals, u_epsilon);
    v_exact_normal = ripple_normal(in_position, EXACT, u_epsilon);
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
