#version 330 core
// A sphere whose size follows the time.
#include "lib/frame.glsl"

in vec3 in_position;

out vec3 v_position;
out vec3 v_normal;

void main() {
    v_normal = in_position;
    v_position = (1.0 + 0.05 * sin(u_frame.time)) * in_position;
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
