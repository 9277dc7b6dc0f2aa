#version 330 core
// A corner of a flat triangle.
#include "insets/placing.glsl"

in vec3 in_place;
in vec3 in_normal;
in vec3 in_frame;
in vec3 in_color;

out vec3 v_normal;
out vec3 v_to_eye;
flat out vec3 v_color;

void main() {
    v_normal = in_normal;
    v_to_eye = towards_eye(in_place, in_frame);
    v_color = in_color;
    gl_Position = placed(in_place, in_frame);
}
