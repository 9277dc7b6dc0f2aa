#version 330 core
// Green for the exact normal, orange for the other.
#include "lib/lighting.glsl"
#include "lib/color.glsl"

uniform bool u_exact;

in vec3 v_position;
in vec3 v_normal;

out vec4 out_color;

void main() {
    vec3 color = okabe_ito(u_exact ? 3 : 1);
    out_color = vec4(0.5 * color + 0.5 * studio_light(v_position, normalize(v_normal), color, 0.6), 1.0);
}
