// A vertex's own bones, as viewer/engine/skin.py sends them: four, or eight in two groups.
// void skin_vertex(inout vec3 position, inout vec3 normal): moved by them.
// float weight_of(int bone): what a bone weighs here.
#include "lib/skinning.glsl"

in uvec4 in_joints;
in vec4 in_weights;
#if INFLUENCES == 8
in uvec4 in_more_joints;
in vec4 in_more_weights;
#endif

float weight_among(uvec4 joints, vec4 weights, int bone) {
    return dot(weights, vec4(equal(ivec4(joints), ivec4(bone))));
}

void skin_vertex(inout vec3 position, inout vec3 normal) {
#if INFLUENCES == 8
    skinned(position, normal, in_joints, in_weights, in_more_joints, in_more_weights);
#else
    skinned(position, normal, in_joints, in_weights);
#endif
}

float weight_of(int bone) {
    float weight = weight_among(in_joints, in_weights, bone);
#if INFLUENCES == 8
    weight += weight_among(in_more_joints, in_more_weights, bone);
#endif
    return weight;
}
