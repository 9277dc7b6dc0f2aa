#version 330 core
// One upright rectangle of whole pixels: a letter, or the plate beneath a label's letters.
#include "lib/frame.glsl"

in vec4 in_anchor;       // a place in the world (w = 1), or across and up in the picture, each -1 to 1 (w = 0)
in vec4 in_rectangle;    // from the anchor's pixel, in pixels: lower left corner, width and height
in vec2 in_sheet;        // where on the sheet the letter's lower left corner is, in texels
in float in_radius;      // of a plate's corners, in pixels; below 0 for a letter
in vec4 in_color;        // sRGB

flat out vec4 v_rectangle;
flat out vec2 v_sheet;
flat out float v_radius;
flat out vec4 v_color;

// A place exactly between two pixels, such as the middle of an odd width, must not depend on the last bit.
const float ROUNDING = 0.51;

void main() {
    vec4 place = in_anchor.w > 0.5 ? u_frame.view_projection * vec4(in_anchor.xyz, 1.0)
                                   : vec4(in_anchor.xy, 0.0, 1.0);
    bool behind_the_eye = place.w <= 0.0;
    vec2 pixel = floor((0.5 * place.xy / place.w + 0.5) * u_frame.resolution + ROUNDING);
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);

    v_rectangle = vec4(pixel + in_rectangle.xy, in_rectangle.zw);
    v_sheet = in_sheet;
    v_radius = in_radius;
    v_color = in_color;
    vec2 clip = 2.0 * (v_rectangle.xy + corner * v_rectangle.zw) / u_frame.resolution - 1.0;
    gl_Position = behind_the_eye ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(clip, 0.0, 1.0);
}
