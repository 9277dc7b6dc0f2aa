#version 330 core
// A net of light rays: each knot meets the waves, is bent by their slope, and lands on the floor a little aside.
// Seen from above, over one tile of floor and, so that nothing lacks at its edges, a margin around it.
#include "underwater/waves.glsl"

uniform float u_time;
uniform float u_bend;             // how far aside, in tiles, a ray lands for each unit of slope
uniform int u_knots;              // along each side of the net
uniform float u_margin;           // around the tile, in tiles

out vec2 v_start;                 // where the ray met the water

void main() {
    ivec2 knot = ivec2(gl_VertexID % u_knots, gl_VertexID / u_knots);
    v_start = mix(vec2(-u_margin), vec2(1.0 + u_margin), vec2(knot) / float(u_knots - 1));
    vec2 landing = v_start - u_bend * wave_slope(v_start, u_time);
    gl_Position = vec4(2.0 * landing - 1.0, 0.0, 1.0);
}
