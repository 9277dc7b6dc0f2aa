#version 330 core
// A square that faces the eye, on which the fragment shader paints a ball.
#include "insets/placing.glsl"

in vec2 in_corner;            // -1 to 1
in vec3 in_center;
in float in_radius;
in vec3 in_frame;
in vec3 in_color;

out vec2 v_across;
flat out vec3 v_color;
flat out vec3 v_to_eye;

void main() {
    vec3 right = vec3(u_frame.view[0][0], u_frame.view[1][0], u_frame.view[2][0]);
    vec3 up = vec3(u_frame.view[0][1], u_frame.view[1][1], u_frame.view[2][1]);
    v_to_eye = towards_eye(in_center, in_frame);
    v_across = in_corner;
    v_color = in_color;
    vec3 nearest = in_center + in_radius * v_to_eye;      // so that it is not cut in half by what runs through it
    gl_Position = placed(nearest + in_radius * (in_corner.x * right + in_corner.y * up), in_frame);
}
