#version 330 core
// One step of every fish of a school: what it wants, where that takes it, and how its body goes along.
#include "generated/flock.glsl"
#include "fish/flock_neighbours.glsl"
#include "fish/flock_steering.glsl"

uniform sampler2D u_fish;               // itself: three texels, see viewer/kit/swim_school.py
uniform int u_count;
uniform float u_bending;                // which part of the way to its next bend a body makes in a step
uniform float u_banking;                // and to its next bank
uniform float u_school_most_bank;       // radians
uniform float u_school_tail_beat_hz;    // of a fish of size 1 at cruising speed

layout(location = 0) out vec4 out_place;        // xyz place, w phase
layout(location = 1) out vec4 out_motion;       // xyz velocity, w length of the body
layout(location = 2) out vec4 out_posture;      // bend, bank, will

const float FULL_TURN = 6.283185307179586;

// How fast it turns about the vertical, in radians a second, positive to the left.
float turning_rate(vec3 before, vec3 now) {
    return atan(before.z * now.x - before.x * now.z, before.x * now.x + before.z * now.z) / u_step;
}

vec4 own_texel(int fish, int part) {
    return texelFetch(u_fish, ivec2(3 * (fish & FISH_IN_ROW - 1) + part, fish >> FISH_ROW_BITS), 0);
}

// Sixteen fish that follow upon each other lie in a square of four by four texels: processors that take such squares
// at once find them in the same cells, with as many neighbours.
int fish_of(ivec2 texel) {
    ivec2 square = texel >> 2, within = texel & 3;
    return (square.y * (FISH_IN_ROW / 4) + square.x) * 16 + within.y * 4 + within.x;
}

void main() {
    int fish = min(fish_of(ivec2(gl_FragCoord.xy)), u_count - 1);
    vec4 place = own_texel(fish, 0), motion = own_texel(fish, 1), posture = own_texel(fish, 2);
    float size = motion.w, will = posture.z;

    vec3 wish = social_wish(fish, place.xyz, motion.xyz, int(posture.w));
    wish += own_wish(motion.xyz, size, will);
    vec3 velocity = steered(place.xyz, motion.xyz, wish, will);
    float speed = length(velocity), rate = turning_rate(motion.xyz, velocity);

    float beat = u_school_tail_beat_hz * speed / (cruising() * size);
    float bend = clamp(rate * size / speed, -MOST_BEND, MOST_BEND);
    float bank = u_school_most_bank * clamp(rate / FULL_BANK_RATE, -1.0, 1.0);
    out_place = vec4(kept_inside(place.xyz + u_step * velocity), mod(place.w + FULL_TURN * beat * u_step, FULL_TURN));
    out_motion = vec4(velocity, size);
    out_posture = vec4(mix(posture.x, bend, u_bending), mix(posture.y, bank, u_banking), will, 0.0);
}
