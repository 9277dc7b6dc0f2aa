#version 330 core
// A mesh that already stands in the world.
#include "lib/frame.glsl"

in vec3 in_position;
in vec3 in_normal;

out vec3 v_position;
out vec3 v_normal;

void main() {
    v_position = in_position;
    v_normal = in_normal;
    gl_Position = u_frame.view_projection * vec4(in_position, 1.0);
}
