#version 330 core
// A rod with six sides: one instance each.
#include "insets/placing.glsl"

in vec3 in_side;              // the corner of a rod of length one: across, across, along
in vec3 in_start;
in vec3 in_end;
in float in_radius;
in vec3 in_frame;
in vec3 in_color;

out vec3 v_normal;
out vec3 v_to_eye;
flat out vec3 v_color;

void main() {
    vec3 along = in_end - in_start;
    vec3 helper = abs(along.y) < 0.9 * length(along) ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 first = normalize(cross(helper, along));
    vec3 second = normalize(cross(along, first));
    v_normal = in_side.x * first + in_side.y * second;
    vec3 place = in_start + in_side.z * along + in_radius * v_normal;
    v_to_eye = towards_eye(place, in_frame);
    v_color = in_color;
    gl_Position = placed(place, in_frame);
}
