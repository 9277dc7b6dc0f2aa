#version 330 core
// A plate in the picture, behind the models and in front of the world.

uniform vec4 u_plate;         // left, bottom, right, top, each -1 to 1

out vec2 v_place;             // 0 to 1

void main() {
    v_place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(mix(u_plate.xy, u_plate.zw, v_place), -0.8, 1.0);
}
