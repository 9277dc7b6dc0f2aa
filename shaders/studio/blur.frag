#version 330 core
// Moments blurred along one direction.
#include "lib/blur.glsl"

uniform sampler2D u_moments;
uniform vec2 u_stride;             // from one tap to the next, in texture coordinates
uniform vec2 u_size;               // of the target, in pixels

out vec2 out_moments;

void main() {
    vec2 place = gl_FragCoord.xy / u_size;
    vec2 sum = vec2(0.0);
    for (int tap = -BLUR_TAPS; tap <= BLUR_TAPS; ++tap)
        sum += blur_weight(tap) * texture(u_moments, place + float(tap) * u_stride).rg;
    out_moments = sum;
}
