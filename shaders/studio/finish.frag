#version 330 core
// From linear light to the screen: tone mapping, then sRGB encoding, then a dither against banding.
#include "lib/screen.glsl"

uniform sampler2D u_linear;

out vec4 out_color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    out_color = vec4(for_screen(tone_mapped(texelFetch(u_linear, pixel, 0).rgb), pixel), 1.0);
}
