#version 330 core
// The true curve, asked of the formula at every pixel of the board.
#include "lib/color.glsl"
#include "marching_squares/true_curve.glsl"
#include "marching_squares/place.glsl"

in vec2 v_square;

out vec4 out_color;

void main() {
    float ink = true_curve_ink(v_square, 0.5 * picture_units(2.6));
    vec2 from_edge = 0.5 - abs(v_square - 0.5);
    bool on_square = min(from_edge.x, from_edge.y) >= 0.0;
    out_color = vec4(okabe_ito(6), on_square ? ink : 0.0);
}
