#version 330 core
// A needle on a vertex of the fish: along its normal as the bent body has it, or as if the body had only been turned.
#include "lib/frame.glsl"
#include "lib/needle.glsl"
#include "fish/moved.glsl"

uniform bool u_exact;
uniform float u_needle_length;

in vec3 in_corner;
in vec3 in_position;
in vec3 in_normal;
in uvec4 in_joints;
in vec4 in_weights;

out vec3 v_position;
out vec3 v_normal;

void main() {
    FishPose pose = fish_pose(0);
    vec3 root = in_position, along = in_normal;
    move_fish(root, along, in_joints, in_weights, pose);
    if (!u_exact) {
        vec3 rest = in_position, normal = in_normal;
        skinned(rest, normal, in_joints, in_weights);
        BodyPlace body = body_at(clamp(MIDDLE - rest.x, 0.0, 1.0), pose.phase, pose.bend);
        along = pose.turn * normalize(out_of_body(normal, body, u_swim_yaw * sin(pose.phase)));
    }
    v_normal = needle_side(in_corner, along);
    v_position = needle_corner(in_corner, root, along, pose.size * u_needle_length);
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
