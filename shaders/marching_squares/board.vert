#version 330 core
// A box whose front is the board: the unit square with a margin around it.
#include "marching_squares/place.glsl"

in vec3 in_position;              // the box's corners, the front at z = 0
in vec3 in_normal;

out vec3 v_position;
out vec3 v_normal;
out vec2 v_square;                // the place in the unit square

void main() {
    v_position = in_position;
    v_normal = in_normal;
    v_square = 0.5 + 0.5 * in_position.xy;
    gl_Position = u_frame.view_projection * vec4(in_position, 1.0);
}
