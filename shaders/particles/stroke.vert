#version 330 core
// A piece of a line as a quad that keeps its width in pixels, however far away.
#include "lib/frame.glsl"

in vec3 in_start;
in vec3 in_end;
in vec4 in_color;
in float in_width;                  // in pixels

out float v_across;                 // in pixels from the middle
flat out vec4 v_color;
flat out float v_half_width;

vec4 before_the_eye(vec4 place, vec4 other) {
    const float NEAREST = 1e-3;
    return place.w >= NEAREST ? place : mix(place, other, (NEAREST - place.w) / max(other.w - place.w, 1e-9));
}

void main() {
    vec4 first = u_frame.view_projection * vec4(in_start, 1.0);
    vec4 second = u_frame.view_projection * vec4(in_end, 1.0);
    if (first.w <= 1e-3 && second.w <= 1e-3) {
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
        return;
    }
    vec4 start = before_the_eye(first, second), end = before_the_eye(second, first);
    vec2 along = (end.xy / end.w - start.xy / start.w) * u_frame.resolution;
    along = dot(along, along) > 1e-12 ? normalize(along) : vec2(1.0, 0.0);
    float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
    float reach = 0.5 * in_width + 1.0;
    vec4 place = gl_VertexID < 2 ? start : end;
    vec2 moved = reach * side * vec2(-along.y, along.x) + (gl_VertexID < 2 ? -0.5 : 0.5) * in_width * along;
    place.xy += 2.0 * moved / u_frame.resolution * place.w;
    gl_Position = place;
    v_across = reach * side;
    v_color = in_color;
    v_half_width = 0.5 * in_width;
}
