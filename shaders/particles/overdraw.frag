#version 330 core
// From the number of sprites on a pixel to the colour map; where there is none, nothing.
#include "lib/color.glsl"

uniform sampler2D u_counts;
uniform int u_overdraw_most;

out vec4 out_color;

void main() {
    float count = texelFetch(u_counts, ivec2(gl_FragCoord.xy), 0).r;
    out_color = count > 0.5 ? vec4(viridis(count / float(u_overdraw_most)), 1.0) : vec4(0.0);
}
