#version 330 core
// Puts each newborn into its slot: one point, one texel.

uniform int u_batch_width;
uniform ivec2 u_slots;                  // across and up

in uint in_slot;

flat out ivec2 v_newborn;

void main() {
    v_newborn = ivec2(gl_VertexID % u_batch_width, gl_VertexID / u_batch_width);
    vec2 slot = vec2(int(in_slot) % u_slots.x, int(in_slot) / u_slots.x) + 0.5;
    gl_Position = vec4(2.0 * slot / vec2(u_slots) - 1.0, 0.0, 1.0);
    gl_PointSize = 1.0;
}
