#version 330 core
#include "lib/backdrop.glsl"

out vec4 out_color;

void main() {
    out_color = vec4(backdrop(gl_FragCoord.xy), 1.0);
}
