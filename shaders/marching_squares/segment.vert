#version 330 core
// A segment as a rectangle that faces the picture, so many pixels wide, with room for round ends.
#include "marching_squares/place.glsl"

uniform float u_width;            // in pixels of a picture 720 pixels high

in vec2 in_from;
in vec2 in_to;

out vec2 v_from_start;            // pixels along and across, from where the segment begins
flat out float v_length;
flat out float v_half_width;

void main() {
    vec4 start = on_board(in_from), end = on_board(in_to);
    vec2 along = in_pixels(end) - in_pixels(start);
    v_length = length(along);
    along = v_length > 1e-6 ? along / v_length : vec2(1.0, 0.0);
    v_half_width = 0.5 * picture_units(u_width);
    float reach = v_half_width + 1.0;
    bool at_end = gl_VertexID > 1;
    float side = gl_VertexID % 2 == 0 ? -reach : reach;
    v_from_start = vec2(at_end ? v_length + reach : -reach, side);
    vec4 place = at_end ? end : start;
    vec2 offset = (at_end ? reach : -reach) * along + side * vec2(-along.y, along.x);
    bool in_view = start.w > 0.0 && end.w > 0.0;
    gl_Position = in_view ? place + vec4(2.0 * offset / u_frame.resolution * place.w, 0.0, 0.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
