// The unit square as the samples have it: a coloured pixel and a sign for each, and what is known of each cell.
// vec3 sampled_color(ivec2 s): the colour of sample s.   float sign_ink(vec2 from_sample, ivec2 s, float size, float pixel)
// vec3 readable_on(vec3 color): what shows up on a colour.
// float cover(float inside, float pixel): how much of a pixel a shape covers.
#include "lib/frame.glsl"
#include "lib/color.glsl"

uniform sampler2D u_samples;      // red: where in the colours the value lies, green: -1 inside, 1 outside, 0 no value
uniform usampler2D u_cells;       // what is known of each cell, in bits
uniform int u_cell_count;         // cells along an axis
uniform int u_colouring;          // 0 diverging from the level, 1 viridis

const uint CROSSED = 16u;         // bits 0 to 3 are the case
const uint AMBIGUOUS = 32u;
const uint NO_CURVE = 64u;        // the function jumps here, or has no value
const uint FADED = 128u;          // not of the case asked for, or not yet come to

const vec3 PAPER = vec3(0.86, 0.84, 0.79);
const vec3 INK = vec3(0.008, 0.009, 0.012);
const vec3 NO_VALUE = vec3(0.30, 0.30, 0.31);

// How much of a pixel a shape covers whose border is `inside` away, positive within.
float cover(float inside, float pixel) {
    return clamp(0.5 + inside / pixel, 0.0, 1.0);
}

vec3 sampled_color(ivec2 s) {
    vec2 known = texelFetch(u_samples, s, 0).rg;
    if (known.g == 0.0)
        return NO_VALUE;
    if (u_colouring == 1)
        return viridis(known.r);
    float far = 0.22 + 0.78 * abs(known.r);
    vec3 below = mix(vec3(0.66, 0.77, 0.86), vec3(0.030, 0.180, 0.410), far);
    vec3 above = mix(vec3(0.86, 0.80, 0.66), vec3(0.730, 0.330, 0.030), far);
    return known.g < 0.0 ? below : above;
}

// Dark on light, light on dark.
vec3 readable_on(vec3 color) {
    return dot(color, vec3(0.2, 0.7, 0.1)) > 0.16 ? INK : PAPER;
}

// A plus or a minus of half width `size` around a sample.
float sign_ink(vec2 from_sample, ivec2 s, float size, float pixel) {
    float inside = texelFetch(u_samples, s, 0).g;
    vec2 bar = vec2(size, 0.24 * size) - abs(from_sample);
    float shape = min(bar.x, bar.y);
    if (inside > 0.0) {
        vec2 upright = vec2(0.24 * size, size) - abs(from_sample);
        shape = max(shape, min(upright.x, upright.y));
    }
    return inside == 0.0 ? 0.0 : cover(shape, pixel);
}
