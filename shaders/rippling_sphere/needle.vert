#version 330 core
// A thin pyramid standing on the rippled sphere along a normal: one instance for each needle.
#include "rippling_sphere/ripple.glsl"

uniform int u_way;
uniform float u_epsilon;
uniform float u_needle_length;

in vec3 in_corner;                // across, across, along: the pyramid's own corner
in vec3 in_root;                  // the point of the unit sphere that the needle stands on

out vec3 v_position;
out vec3 v_normal;

void main() {
    vec3 along = ripple_normal(in_root, u_way, u_epsilon);
    vec3 first, second;
    tangents(along, first, second);
    vec3 across = in_corner.x * first + in_corner.y * second;
    v_normal = across;
    v_position = rippled(in_root) + u_needle_length * (0.035 * across + in_corner.z * along);
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
