#version 330 core
// From the light's depths to their moments, blurred across. The floor counts as seen by the light too,
// so that the moments around a shadow's edge are those of floor and caster alone.
#include "lib/blur.glsl"

uniform sampler2D u_depth;
uniform vec3 u_floor;              // the floor's depth at u, v in the shadow map: dot(u_floor, (u, v, 1))

out vec2 out_moments;

vec2 moments(vec2 place) {
    float seen = texture(u_depth, place).r;
    float floor_depth = dot(u_floor, vec3(place, 1.0));
    float depth = seen < 1.0 ? min(seen, floor_depth) : floor_depth;
    return vec2(depth, depth * depth);
}

void main() {
    vec2 size = vec2(textureSize(u_depth, 0));
    vec2 place = 2.0 * gl_FragCoord.xy / size;
    vec2 sum = vec2(0.0);
    for (int tap = -BLUR_TAPS; tap <= BLUR_TAPS; ++tap)
        sum += blur_weight(tap) * moments(place + vec2(2.0 * float(tap) / size.x, 0.0));
    out_moments = sum;
}
