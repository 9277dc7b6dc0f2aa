#version 330 core
// A rectangle of the picture, in front of everything.

uniform vec4 u_rectangle;         // left, bottom, right, top in the picture, each -1 to 1
uniform float u_margin;           // room around the cell, in cells
uniform float u_depth;

out vec2 v_cell;                  // the place in the cell, 0 to 1

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    v_cell = mix(vec2(-u_margin), vec2(1.0 + u_margin), corner);
    gl_Position = vec4(mix(u_rectangle.xy, u_rectangle.zw, corner), u_depth, 1.0);
}
