#version 330 core
// Keeps each path's latest point in the block of those with its number.

uniform sampler2D u_places;
uniform ivec2 u_corner;             // of the block

out vec4 out_point;

void main() {
    out_point = texelFetch(u_places, ivec2(gl_FragCoord.xy) - u_corner, 0);
}
