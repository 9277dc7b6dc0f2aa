#version 330 core
// Like finish_samples.frag, with the layer of sprites in front: it lies over each sample, so that the edges
// of what shines through stay smooth.
#include "lib/screen.glsl"
#include "studio/sprites.glsl"

uniform sampler2DMS u_linear;
uniform int u_samples;

out vec4 out_color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sprites = sprites_at(pixel);
    vec3 sum = vec3(0.0);
    for (int one = 0; one < u_samples; ++one)
        sum += tone_mapped(behind(sprites, texelFetch(u_linear, pixel, one).rgb));
    out_color = vec4(for_screen(sum / float(u_samples), pixel), 1.0);
}
