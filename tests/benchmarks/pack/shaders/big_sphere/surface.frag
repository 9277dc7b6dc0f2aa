#version 330 core
// Lit by the studio.
#include "lib/lighting.glsl"

in vec3 v_position;
in vec3 v_normal;

out vec4 out_color;

void main() {
    out_color = vec4(studio_light(v_position, normalize(v_normal), vec3(0.69, 0.095, 0.023), 0.35), 1.0);
}
