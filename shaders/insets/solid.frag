#version 330 core
// Rods and faces. What is seen from its back is darker.
#include "insets/shading.glsl"
#include "lib/color.glsl"

in vec3 v_normal;
in vec3 v_to_eye;
flat in vec3 v_color;

out vec4 out_color;

void main() {
    vec3 normal = normalize(v_normal), to_eye = normalize(v_to_eye);
    bool behind = dot(normal, to_eye) < 0.0;
    vec3 color = linear_light(v_color);
    out_color = vec4(model_light(behind ? -normal : normal, to_eye, behind ? 0.66 * color : color), 1.0);
}
