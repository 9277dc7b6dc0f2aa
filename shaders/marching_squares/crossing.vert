#version 330 core
// A spot at either end of a segment, where the curve crosses an edge; gone where cells are too small for it.
#include "marching_squares/place.glsl"

uniform int u_cell_count;

in vec2 in_from;
in vec2 in_to;

out vec2 v_from_middle;           // in pixels
flat out float v_radius;

void main() {
    vec2 here = gl_VertexID < 6 ? in_from : in_to;
    int corner = gl_VertexID % 6;
    vec2 side = vec2(corner == 1 || corner == 2 || corner == 4 ? 1.0 : -1.0, corner == 2 || corner > 3 ? 1.0 : -1.0);
    vec4 middle = on_board(here);
    vec2 beside = in_pixels(on_board(here + vec2(1.0 / float(u_cell_count), 0.0))) - in_pixels(middle);
    v_radius = min(picture_units(6.0), 0.16 * length(beside));
    v_from_middle = (v_radius + 1.0) * side;
    bool shown = middle.w > 0.0 && v_radius > 1.6;
    middle.z -= 0.0005 * middle.w;
    gl_Position = shown ? middle + vec4(2.0 * v_from_middle / u_frame.resolution * middle.w, 0.0, 0.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
