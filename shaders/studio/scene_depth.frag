#version 330 core
// The picture's depth, once into a texture that sprites may read and once into their own depth buffer:
// what is attached to the target that is drawn into must not be read.

uniform sampler2D u_depth;

out float out_depth;

void main() {
    out_depth = texelFetch(u_depth, ivec2(gl_FragCoord.xy), 0).r;
    gl_FragDepth = out_depth;
}
