#version 330 core
// Orange for the normal in use, green for the exact one.
#include "lib/lighting.glsl"
#include "lib/color.glsl"

uniform int u_way;

in vec3 v_position;
in vec3 v_normal;

out vec4 out_color;

void main() {
    vec3 color = okabe_ito(u_way == 3 ? 3 : 1);
    vec3 normal = dot(v_normal, v_normal) > 0.0 ? normalize(v_normal) : vec3(0.0, 1.0, 0.0);
    out_color = vec4(0.5 * color + 0.5 * studio_light(v_position, normal, color, 0.6), 1.0);
}
