#version 330 core
// A square of floor, wide enough to fade into the backdrop before it ends. Its corners turn counter-clockwise
// seen from above: from below there is no floor, and nothing hides the scene.
#include "lib/frame.glsl"

out vec3 v_position;

void main() {
    vec2 corner = vec2(gl_VertexID >= 2 ? 1.0 : -1.0, gl_VertexID == 1 || gl_VertexID == 2 ? 1.0 : -1.0);
    v_position = vec3(u_frame.center.x, u_frame.ground_height, u_frame.center.z) + 7.0 * u_frame.radius * vec3(corner.x, 0.0, corner.y);
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
