#version 330 core
// A line in the picture: one instance each, a rectangle as long as it is, with room for its soft edges beside it.
#include "lib/frame.glsl"

in vec2 in_from;              // in the picture, each -1 to 1
in vec2 in_to;
in float in_width;            // in thousandths of the picture's height
in vec3 in_color;

out float v_across;           // from the middle of the line, in pixels
flat out float v_half_width;
flat out vec3 v_color;

void main() {
    vec2 half_size = 0.5 * u_frame.resolution;
    vec2 start = in_from * half_size, end = in_to * half_size;
    float size = distance(start, end);
    v_half_width = max(0.6, 0.0005 * in_width * u_frame.resolution.y);
    v_color = in_color;
    vec2 along = size > 0.0 ? (end - start) / size : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    float room = v_half_width + 1.0;
    v_across = gl_VertexID < 2 ? -room : room;
    float lap = 0.5 + 0.1 * v_half_width;      // so that lines that follow each other leave no gaps
    vec2 place = ((gl_VertexID & 1) == 0 ? start - lap * along : end + lap * along) + v_across * across;
    gl_Position = vec4(place / half_size, -0.9, 1.0);
}
