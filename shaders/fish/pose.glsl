// Where a fish is and how it lies: one of a school, whose state lies in a texture, or the only one, at the origin.
// FishPose fish_pose(int instance): of the instance that is drawn.
// vec3 place_of(FishPose pose, vec3 p): where the point p of the fish is in the world.

uniform int u_school;                   // how many fish there are; 1: nobody but the hero
uniform float u_phase;                  // the hero's: where in its beat it is, in radians
uniform float u_turn;                   // and its bend, in degrees
uniform int u_fish_first;               // which of the school the first instance is
uniform int u_fish_stride;              // and how many further on the next one
uniform sampler2D u_school_state;       // three texels a fish: xyz place, w phase; xyz velocity, w length of its body;
                                        // x bend of the body, y bank, both in radians and positive to the left

struct FishPose {
    mat3 turn;          // its columns: ahead, up and right, in the world
    vec3 place;
    float size;         // the length of its body
    float phase;        // where in its beat it is, in radians
    float bend;         // angle between tail and nose, in radians, positive to the left
};

FishPose fish_pose(int instance) {
    if (u_school <= 1)
        return FishPose(mat3(1.0), vec3(0.0), 1.0, u_phase, radians(u_turn));
    int fish = u_fish_first + u_fish_stride * instance, in_row = textureSize(u_school_state, 0).x / 3;
    ivec2 texel = ivec2(3 * (fish % in_row), fish / in_row);
    vec4 place = texelFetch(u_school_state, texel, 0), motion = texelFetch(u_school_state, texel + ivec2(1, 0), 0);
    vec2 posture = texelFetch(u_school_state, texel + ivec2(2, 0), 0).xy;

    vec3 ahead = normalize(motion.xyz);
    vec3 level = normalize(vec3(-ahead.z, 0.0, ahead.x));       // to its right, and neither up nor down
    vec3 above = cross(level, ahead);
    float sine = sin(posture.y), cosine = cos(posture.y);
    mat3 turn = mat3(ahead, cosine * above - sine * level, cosine * level + sine * above);
    return FishPose(turn, place.xyz, motion.w, place.w, posture.x);
}

vec3 place_of(FishPose pose, vec3 p) {
    return pose.place + pose.turn * (pose.size * p);
}
