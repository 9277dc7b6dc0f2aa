#version 330 core
// Linear blend skinning, or its cure: each vertex follows its bones. Then the model is put in its place in the studio.
#include "lib/frame.glsl"
#include "lib/skin_vertex.glsl"
#include "generated/posed_before.glsl"        // POSED_BEFORE: whether a pass has done it already, for a large mesh

uniform sampler2D u_posed_places;
uniform sampler2D u_posed_normals;
uniform vec3 u_model_middle;      // what stands at the origin of the world
uniform float u_model_scale;
uniform vec3 u_aside;             // how far it is moved from there
uniform vec2 u_turned;            // and turned around the vertical: cosine and sine
uniform int u_weighed_bone;       // the bone whose weights are shown; -1: none

in vec3 in_position;
in vec3 in_normal;
in vec2 in_texcoord;

out vec3 v_posed;                 // in the model's own space, as it is exported
out vec3 v_posed_normal;
out vec3 v_position;              // in the world
out vec3 v_normal;
out vec2 v_texcoord;
out float v_weight;

vec3 turned(vec3 v) {
    return vec3(u_turned.x * v.x + u_turned.y * v.z, v.y, u_turned.x * v.z - u_turned.y * v.x);
}

void main() {
    v_posed = in_position;
    v_posed_normal = in_normal;
    if (POSED_BEFORE) {
        ivec2 texel = ivec2(gl_VertexID % POSED_WIDTH, gl_VertexID / POSED_WIDTH);
        v_posed = texelFetch(u_posed_places, texel, 0).xyz;
        v_posed_normal = texelFetch(u_posed_normals, texel, 0).xyz;
    } else {
        skin_vertex(v_posed, v_posed_normal);
    }
    v_position = turned(u_model_scale * (v_posed - u_model_middle)) + u_aside;
    v_normal = turned(v_posed_normal);
    v_texcoord = in_texcoord;
    v_weight = weight_of(u_weighed_bone);
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
