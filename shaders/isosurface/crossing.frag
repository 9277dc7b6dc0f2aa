#version 330 core
// One vertex of the surface: where it crosses an edge of the grid, and how it lies there.
#include "lib/frame.glsl"
#include "lib/grid.glsl"
#include "generated/field.glsl"
#include "isosurface/shape.glsl"

uniform sampler2D u_values;
uniform usampler2D u_crossings;       // 8 times the number of the sample where the edge starts, plus its direction
uniform float u_surface_level;
uniform bool u_find_jumps;
uniform bool u_bends;                 // whether the curvature is wanted

layout(location = 0) out vec4 out_place;      // in the field's own space; 1 where the field jumps instead
layout(location = 1) out vec4 out_normal;     // and the mean curvature
layout(location = 2) out float out_jump;      // in 255ths

const float NEAREST = 1e-4;           // as near to a sample as a vertex may come, in edges
const int HALVINGS = 20;

float value_at(ivec3 s) {
    return texelFetch(u_values, grid_texel(s), 0).r - u_surface_level;
}

// Whether the values at the ends of an edge stay apart however much of it is cut off: a pole or a step.
// Where the field is continuous they come together around the crossing.
bool jumps(vec3 start, vec3 end, float A, float B, float t) {
    float between = field(mix(start, end, t)) - u_surface_level;
    if (abs(between) <= 0.25 * min(abs(A), abs(B)))
        return false;
    float low = 0.0, high = 1.0, at_low = A, at_high = B;
    for (int halving = 0; halving < HALVINGS; halving++) {
        float middle = 0.5 * (low + high);
        float value = field(mix(start, end, middle)) - u_surface_level;
        if ((value < 0.0) == (A < 0.0)) { low = middle; at_low = value; }
        else { high = middle; at_high = value; }
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
    out_jump = float(u_find_jumps && jumps(start, end, A, B, t)) / 255.0;
    out_place = vec4(place, 255.0 * out_jump);
    out_normal = vec4(surface_normal(place), u_bends ? mean_curvature(place) : 0.0);
}
