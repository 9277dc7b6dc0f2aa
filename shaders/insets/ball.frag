#version 330 core
// A ball, painted on a square.
#include "insets/shading.glsl"
#include "lib/color.glsl"

in vec2 v_across;
flat in vec3 v_color;
flat in vec3 v_to_eye;

out vec4 out_color;

void main() {
    float squared = dot(v_across, v_across);
    if (squared > 1.0)
        discard;
    vec3 right = vec3(u_frame.view[0][0], u_frame.view[1][0], u_frame.view[2][0]);
    vec3 up = vec3(u_frame.view[0][1], u_frame.view[1][1], u_frame.view[2][1]);
    vec3 backwards = vec3(u_frame.view[0][2], u_frame.view[1][2], u_frame.view[2][2]);
    vec3 normal = v_across.x * right + v_across.y * up + sqrt(1.0 - squared) * backwards;
    out_color = vec4(model_light(normal, backwards, linear_light(v_color)), 1.0);
}
