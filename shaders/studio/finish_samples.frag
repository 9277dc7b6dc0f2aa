#version 330 core
// Like finish.frag, for several samples a pixel. Each sample's tone is mapped before they are averaged,
// so that one bright sample does not eat the smoothness of an edge.
#include "lib/screen.glsl"

uniform sampler2DMS u_linear;
uniform int u_samples;

out vec4 out_color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 sum = vec3(0.0);
    for (int one = 0; one < u_samples; ++one)
        sum += tone_mapped(texelFetch(u_linear, pixel, one).rgb);
    out_color = vec4(for_screen(sum / float(u_samples), pixel), 1.0);
}
