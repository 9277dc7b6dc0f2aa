#version 330 core
// A vertex of a fish, moved to where it is now; what it is at rest goes along, since the skin's pattern hangs on that.
#include "lib/underwater.glsl"
#include "lib/color.glsl"
#include "particles/random.glsl"
#include "fish/moved.glsl"

uniform float u_swing_scale;      // the swing at the bright end of the colours, in body lengths

in vec3 in_position;
in vec3 in_normal;
in vec2 in_coordinates;           // along and around the body, along the root and out on a fin, ahead and up on an eye
in vec2 in_lattice;               // girths from the nose; on fins, how many rays they have
in int in_part;
in uvec4 in_joints;
in vec4 in_weights;

out vec3 v_position;
out vec3 v_normal;
out vec3 v_rest;
out vec2 v_coordinates;
out vec2 v_lattice;
out vec4 v_telling;               // what the colours tell, where they tell anything
out vec4 v_light;                 // what falls on a fish that is far, and how much of it the water hides
flat out vec3 v_ahead;            // the way that the fish swims
flat out int v_part;
flat out uint v_fish;             // which fish, as a random number

// How far this vertex swings in a beat: from where it is at four moments of it.
float swing_of(FishPose pose) {
    vec3 places[4];
    for (int quarter = 0; quarter < 4; quarter++) {
        vec3 normal = in_normal;
        places[quarter] = in_position;
        swim(places[quarter], normal, 1.5707963 * float(quarter), pose.bend);
    }
    return 0.5 * length(vec2(length(places[0] - places[2]), length(places[1] - places[3])));
}

vec4 telling(FishPose pose) {
    if (COLOURING == SWING)
        return vec4(swing_of(pose) / u_swing_scale);
    if (COLOURING == WEIGHTS) {
        vec3 color = vec3(0.0);
        for (int number = 0; number < 4; number++) {
            int joint = int(in_joints[number]);
            color += in_weights[number] * (joint == 0 ? vec3(0.30) : okabe_ito(1 + (joint - 1) % 7));
        }
        return vec4(color, 0.0);
    }
    return vec4(0.0);
}

void main() {
    FishPose pose = fish_pose(gl_InstanceID);
    v_position = in_position;
    v_normal = in_normal;
    move_fish(v_position, v_normal, in_joints, in_weights, pose);
    v_ahead = pose.turn[0];
    v_rest = in_position;
    v_coordinates = in_coordinates;
    v_lattice = in_lattice;
    v_telling = telling(pose);
    v_light = FINE ? vec4(0.0) : vec4(plain_underwater_light(v_normal), veil(v_position));
    v_part = in_part;
    v_fish = pcg(uint(gl_InstanceID) * 2654435761u + uint(u_fish_first));
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
