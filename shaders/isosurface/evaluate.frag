#version 330 core
// The field's value at every sample, and which side of the level that is: all that topology needs.
#include "lib/frame.glsl"
#include "lib/grid.glsl"
#include "lib/number.glsl"
#include "generated/field.glsl"

uniform float u_surface_level;

layout(location = 0) out float out_value;
layout(location = 1) out float out_side;      // in 255ths: 1 inside, 0 outside, 2 no value

void main() {
    out_value = field(grid_place(grid_sample(gl_FragCoord.xy)));
    out_side = (is_finite(out_value) ? float(out_value < u_surface_level) : 2.0) / 255.0;
}
