// Where the unit square stands in the world, and lines and spots of so many pixels on it.
// vec4 on_board(vec2 p): the place p of the square in clip space.   vec2 in_pixels(vec4 clip)
// float picture_units(float): lengths given for a picture 720 pixels high.
#include "lib/frame.glsl"

vec4 on_board(vec2 p) {
    return u_frame.view_projection * vec4(2.0 * p - 1.0, 0.004, 1.0);
}

vec2 in_pixels(vec4 clip) {
    return 0.5 * clip.xy / clip.w * u_frame.resolution;
}

float picture_units(float pixels) {
    return pixels * max(u_frame.resolution.y, 360.0) / 720.0;
}
