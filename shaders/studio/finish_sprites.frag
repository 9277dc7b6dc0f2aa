#version 330 core
// Like finish.frag, with the layer of sprites in front.
#include "lib/screen.glsl"
#include "studio/sprites.glsl"

uniform sampler2D u_linear;

out vec4 out_color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 light = behind(sprites_at(pixel), texelFetch(u_linear, pixel, 0).rgb);
    out_color = vec4(for_screen(tone_mapped(light), pixel), 1.0);
}
