#version 330 core
// Like scene_depth.frag, for several samples a pixel: the first stands for all, for an average
// of something near and something far would be the depth of neither.

uniform sampler2DMS u_depth;

out float out_depth;

void main() {
    out_depth = texelFetch(u_depth, ivec2(gl_FragCoord.xy), 0).r;
    gl_FragDepth = out_depth;
}
