#version 330 core
// One vertex of the surface whose place is known already: how the surface lies there.
#include "lib/frame.glsl"
#include "lib/grid.glsl"
#include "generated/field.glsl"
#include "generated/asked.glsl"       // BENDS: whether the curvature is wanted
#include "isosurface/shape.glsl"

uniform sampler2D u_places;           // in samples

layout(location = 0) out vec4 out_place;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out float out_jump;

void main() {
    vec3 place = grid_place(texelFetch(u_places, ivec2(gl_FragCoord.xy), 0).xyz);
    out_place = vec4(place, 1.0);
    out_normal = vec4(surface_normal(place), BENDS ? mean_curvature(place) : 0.0);
    out_jump = 0.0;
}
