#version 330 core
// A trail, fading towards its edges as a round thing of glowing gas does; one that hides has edges of a pixel.
#include "generated/trail.glsl"

in vec4 v_across;                   // w: in half widths
in vec4 v_light;

out vec4 out_color;

void main() {
    float across = v_across.x / max(v_across.y, 1e-6);
    float before = clamp(1.0 - v_across.w, 0.0, 1.0);       // its head is round
    across = min(1.0, length(vec2(across, before)));
    float cover = HIDES ? min(1.0, (1.0 - across) * v_across.z) : 1.0 - across * across;
    out_color = cover * v_light;
}
