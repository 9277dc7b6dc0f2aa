// One point of a ribbon that faces the camera.
// void ribbon_point(out ivec2 slot, out int point): which one this fragment is; beyond the last where there is none.
// float pixel_size(vec3 place, vec2 resolution): how wide a pixel is there, in metres.
// float widened(float half_width, vec3 place, float thinnest, float pixel): half the width to draw, in metres: no less
// than so many pixels in all, and not so wide as to fill the eye.
// void ribbon_seen(vec3 before, vec3 here, vec3 after, float half_width, float pixel, float along): writes out_middle
// and out_side; `along` tells the drawing how far from the ribbon's start it is.
#include "generated/ribbon.glsl"
#include "lib/frame.glsl"

uniform int u_first_row;            // of slots, in the ribbons that are now made

layout(location = 0) out vec4 out_middle;
layout(location = 1) out vec4 out_side;
layout(location = 2) out vec4 out_light;

const float LONGEST_MITER = 2.0;    // of half the width
const float WIDEST = 0.05;          // half the width, of the distance to the eye

void ribbon_point(out ivec2 slot, out int point) {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 block = texel / RIBBON_SIZE;
    slot = texel - block * RIBBON_SIZE + ivec2(0, u_first_row);
    point = block.y * RIBBON_COLUMNS + block.x;
}

vec3 in_view(vec3 place) {
    return (u_frame.view * vec4(place, 1.0)).xyz;
}

float pixel_size(vec3 place, vec2 resolution) {
    float depth = (u_frame.projection * vec4(in_view(place), 1.0)).w;
    return 2.0 * max(depth, 1e-6) / (u_frame.projection[1][1] * resolution.y);
}

float widened(float half_width, vec3 place, float thinnest, float pixel) {
    float away = length(in_view(place));
    return max(min(half_width, WIDEST * away), 0.5 * thinnest * pixel);
}

// At right angles to the line from one place to another, as it is seen; zero where that is a point. The line and the
// eye span a plane, and where its normal lies in the picture is across.
vec2 across_line(vec3 from, vec3 way) {
    bool parallel = u_frame.projection[3][3] == 1.0;
    vec3 normal = cross(parallel ? vec3(0.0, 0.0, -1.0) : from, way);
    float size = length(normal.xy);
    return size > 1e-6 ? normal.xy / size : vec2(0.0);
}

vec2 miter(vec2 one, vec2 other) {
    vec2 both = one + other;
    float size = length(both);
    if (size < 0.1)                 // one of them is no line, or the way leads straight back
        return dot(other, other) > 0.0 ? other : one;
    vec2 middle = both / size;
    return middle * min(LONGEST_MITER, 1.0 / max(0.1, max(dot(middle, one), dot(middle, other))));
}

void ribbon_seen(vec3 before, vec3 here, vec3 after, float half_width, float pixel, float along) {
    mat3 turn = mat3(u_frame.view);
    vec3 place = in_view(here);
    vec2 one = across_line(place, turn * (here - before)), other = across_line(place, turn * (after - here));
    vec2 side = half_width * miter(one, other);
    out_middle = u_frame.projection * vec4(place, 1.0);
    out_side = vec4(u_frame.projection[0][0] * side.x, u_frame.projection[1][1] * side.y, half_width / pixel, along);
}
