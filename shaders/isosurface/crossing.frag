#version 330 core
// One vertex of the surface: where it crosses an edge of the grid, and how it lies there.
#include "lib/frame.glsl"
#include "lib/grid.glsl"
#include "lib/number.glsl"
#include "generated/field.glsl"
#include "generated/asked.glsl"       // FIND_JUMPS, and BENDS: whether the curvature is wanted
#include "isosurface/shape.glsl"

uniform sampler2D u_values;
uniform usampler2D u_crossings;       // 8 times the number of the sample where the edge starts, plus its direction
uniform float u_surface_level;

layout(location = 0) out vec4 out_place;      // in the field's own space
layout(location = 1) out vec4 out_normal;     // and the mean curvature
layout(location = 2) out float out_jump;      // in 255ths: 1 where the field jumps instead of crossing

const float NEAREST = 1e-4;           // as near to a sample as a vertex may come, in edges
const int HALVINGS = 20;

float value_at(ivec3 s) {
    return texelFetch(u_values, grid_texel(s), 0).r - u_surface_level;
}

// Whether the values at the ends of an edge stay apart however much of it is cut off: a pole or a step.
// Where the field is continuous they come together around the crossing, and mostly at t already.
bool jumps(vec3 start, vec3 end, float A, float B, float t) {
    float low = 0.0, high = 1.0, at_low = A, at_high = B, at = t;
    for (int halving = 0; halving <= HALVINGS; halving++) {       // one loop, so that compilers meet the field once
        float value = field(mix(start, end, at)) - u_surface_level;
        if (halving == 0 && abs(value) <= 0.25 * min(abs(A), abs(B)))
            return false;
        if (halving > 0 && (value < 0.0) == (A < 0.0)) { low = at; at_low = value; }
        else if (halving > 0) { high = at; at_high = value; }
        at = 0.5 * (low + high);
    }
    return !(abs(at_high - at_low) <= 0.25 * abs(B - A));
}

void main() {
    uint crossing = texelFetch(u_crossings, ivec2(gl_FragCoord.xy), 0).r;
    int number = int(crossing >> 3u), layer = u_grid_samples.x * u_grid_samples.y;
    int z = number / layer, y = (number - z * layer) / u_grid_samples.x;
    ivec3 s = ivec3(number - z * layer - y * u_grid_samples.x, y, z);
    ivec3 direction = ivec3(crossing & 1u, crossing >> 1u & 1u, crossing >> 2u & 1u);
    float A = value_at(s), B = value_at(s + direction);
    float t = clamp(A / (A - B), NEAREST, 1.0 - NEAREST);
    vec3 start = grid_place(vec3(s)), end = grid_place(vec3(s + direction));
    vec3 place = grid_place(vec3(s) + t * vec3(direction));
    bool has_values = is_finite(A) && is_finite(B);       // without one there is a gap already
    out_jump = float(FIND_JUMPS && has_values && jumps(start, end, A, B, t)) / 255.0;
    out_place = vec4(place, 1.0);
    out_normal = vec4(surface_normal(place), BENDS ? mean_curvature(place) : 0.0);
}
