#version 330 core
// An obstacle or an emitter in the studio's light, from either side.
#include "lib/lighting.glsl"

uniform vec3 u_color;           // linear
uniform float u_roughness;

in vec3 v_position;
in vec3 v_normal;

out vec4 out_color;

void main() {
    vec3 normal = normalize(v_normal) * (gl_FrontFacing ? 1.0 : -1.0);
    out_color = vec4(studio_light(v_position, normal, u_color, u_roughness), 1.0);
}
