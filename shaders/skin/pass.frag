#version 330 core
// Skinning as a pass over all vertices, one fragment for each: the same as in a vertex shader, done once for all who
// draw the mesh, and where fragments are shared out to more cores than vertices, faster.
#include "lib/skinning.glsl"

uniform sampler2D u_bound_places;
uniform sampler2D u_bound_normals;
uniform usampler2D u_joints;
uniform sampler2D u_weights;
#if INFLUENCES == 8
uniform usampler2D u_more_joints;
uniform sampler2D u_more_weights;
#endif

layout(location = 0) out vec4 out_place;
layout(location = 1) out vec4 out_normal;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec3 place = texelFetch(u_bound_places, texel, 0).xyz;
    vec3 normal = texelFetch(u_bound_normals, texel, 0).xyz;
    uvec4 joints = texelFetch(u_joints, texel, 0);
    vec4 weights = texelFetch(u_weights, texel, 0);
#if INFLUENCES == 8
    skinned(place, normal, joints, weights, texelFetch(u_more_joints, texel, 0), texelFetch(u_more_weights, texel, 0));
#else
    skinned(place, normal, joints, weights);
#endif
    out_place = vec4(place, 1.0);
    out_normal = vec4(normal, 0.0);
}
