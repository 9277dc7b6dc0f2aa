#version 330 core
// Skinning alone: a place and a normal for each vertex.
#include "lib/skin_vertex.glsl"

in vec3 in_position;
in vec3 in_normal;

out vec3 v_position;
out vec3 v_normal;

void main() {
    v_position = in_position;
    v_normal = in_normal;
    skin_vertex(v_position, v_normal);
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
