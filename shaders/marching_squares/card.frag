#version 330 core
// One cell, enlarged: its corners' pixels and signs, the crossings on its edges, segments and the true curve.
#include "marching_squares/square.glsl"
#include "marching_squares/true_curve.glsl"

uniform ivec2 u_cell;             // which cell; -1: the card itself, empty
uniform vec4 u_first_segment;     // from and to, within the cell
uniform vec4 u_second_segment;
uniform int u_segment_count;
uniform bool u_true_curve;
uniform float u_emphasis;         // 1 as the algorithm has it, less for the answer not taken

in vec2 v_cell;

out vec4 out_color;

const vec3 CARD = vec3(0.80, 0.79, 0.76);

float segment_distance(vec2 p, vec4 segment) {
    vec2 along = segment.zw - segment.xy;
    return length(p - segment.xy - along * clamp(dot(p - segment.xy, along) / dot(along, along), 0.0, 1.0));
}

vec3 cell_drawn(vec2 within) {
    float pixel = 0.5 * (length(dFdx(within)) + length(dFdy(within)));
    ivec2 corner = clamp(ivec2(floor(within + 0.5)), 0, 1);
    vec2 in_cell = 0.5 - abs(within - 0.5);
    float depth = min(in_cell.x, in_cell.y);
    vec3 color = mix(CARD, sampled_color(u_cell + corner), cover(depth, pixel));
    color = mix(color, INK, cover(0.011 - abs(depth), pixel));
    float curve = true_curve_ink((vec2(u_cell) + within) / float(u_cell_count), 0.014 / pixel);
    float to_segment = 9.0, to_end = 9.0;
    for (int i = 0; i < u_segment_count; i++) {
        vec4 segment = i == 0 ? u_first_segment : u_second_segment;
        to_segment = min(to_segment, segment_distance(within, segment));
        to_end = min(to_end, min(length(within - segment.xy), length(within - segment.zw)));
    }
    color = mix(color, INK, u_emphasis * cover(0.024 - to_segment, pixel));
    if (u_true_curve && depth >= 0.0)
        color = mix(color, okabe_ito(6), curve);
    color = mix(color, INK, cover(0.055 - to_end, pixel));
    color = mix(color, vec3(0.95), cover(0.036 - to_end, pixel));
    vec2 from_corner = within - vec2(corner);
    color = mix(color, mix(sampled_color(u_cell + corner), vec3(0.9), 0.6), cover(0.095 - length(from_corner), pixel));
    color = mix(color, INK, cover(0.009 - abs(0.095 - length(from_corner)), pixel));
    return mix(color, INK, sign_ink(from_corner, u_cell + corner, 0.058, pixel));
}

void main() {
    out_color = vec4(u_cell.x < 0 ? CARD : cell_drawn(v_cell), 1.0);
}
