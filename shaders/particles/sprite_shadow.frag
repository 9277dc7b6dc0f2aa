#version 330 core
// Light is stopped or not by chance: blurred, the shadow is as dark as the disc is opaque.
#include "particles/random.glsl"

flat in float v_density;
flat in uint v_identity;

void main() {
    vec2 place = 2.0 * gl_PointCoord - 1.0;
    float density = v_density * max(1.0 - dot(place, place), 0.0);
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    if (random_of(v_identity + pcg(pixel.x + 4096u * pixel.y), 80u) >= density)
        discard;
}
