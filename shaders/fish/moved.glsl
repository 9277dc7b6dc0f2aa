// The way of a point of a fish from rest into the water: its fin paddles, its body bends, the fish is somewhere.
// void move_fish(inout vec3 position, inout vec3 normal, uvec4 joints, vec4 weights, FishPose pose)
// From generated/drawn.glsl: FINE, whether it is near enough for its fins to paddle and its wave to be exact.
#include "lib/skinning.glsl"
#include "fish/swim.glsl"
#include "fish/pose.glsl"
#include "generated/drawn.glsl"

// The bent fish as it is told from afar, where nobody sees a body stretch by a hundredth: its middle line swings
// sideways and is bent along chords of the turn's arc, without an integral, and normals only turn.
void swim_far_away(inout vec3 position, inout vec3 normal, float phase, float turn) {
    float s = clamp(MIDDLE - position.x, 0.0, 1.0), yaw = u_swim_yaw * sin(phase), arc = turn * (MIDDLE - s);
    vec3 here = wave(s, phase);
    vec2 chord = rotated(vec2(MIDDLE - s, u_swim_amplitude * here.x), -0.5 * arc);
    BodyPlace body = BodyPlace(chord, forward_at(s, u_swim_amplitude * here.y, turn), 0.0,
                               u_swim_roll * sin(phase) + u_swim_twist * here.x, 0.0);
    vec2 middle = rotated(body.place, -yaw) + vec2(0.0, u_swim_sway * sin(phase));
    position = vec3(middle.x, 0.0, middle.y) + out_of_body(position - vec3(MIDDLE - s, 0.0, 0.0), body, yaw);
    normal = out_of_body(normal, body, yaw);
}

void move_fish(inout vec3 position, inout vec3 normal, uvec4 joints, vec4 weights, FishPose pose) {
    if (FINE) {
        skinned(position, normal, joints, weights);
        swim(position, normal, pose.phase, pose.bend);
    } else {
        swim_far_away(position, normal, pose.phase, pose.bend);
    }
    position = place_of(pose, position);
    normal = pose.turn * normal;
}
