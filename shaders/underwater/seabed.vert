#version 330 core
// A square of sand, wide enough to fade into the water before it ends. Its corners turn counter-clockwise seen
// from above.
#include "lib/frame.glsl"

out vec3 v_position;

void main() {
    vec2 corner = vec2(gl_VertexID >= 2 ? 1.0 : -1.0, gl_VertexID == 1 || gl_VertexID == 2 ? 1.0 : -1.0);
    vec3 middle = vec3(u_frame.center.x, u_frame.ground_height, u_frame.center.z);
    v_position = middle + u_frame.radius * vec3(40.0 * corner.x, 0.003, 40.0 * corner.y);
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
