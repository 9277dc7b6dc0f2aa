#version 330 core
// A thin pyramid standing on the rippled sphere along a normal: one instance for each needle.
#include "rippling_sphere/ripple.glsl"
#include "lib/needle.glsl"

uniform int u_way;
uniform float u_epsilon;
uniform float u_needle_length;

in vec3 in_corner;                // across, across, along: the pyramid's own corner
in vec3 in_root;                  // the point of the unit sphere that the needle stands on

out vec3 v_position;
out vec3 v_normal;

void main() {
    vec3 along = ripple_normal(in_root, u_way, u_epsilon);
    v_normal = needle_side(in_corner, along);
    v_position = needle_corner(in_corner, rippled(in_root), along, u_needle_length);
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
