#version 330 core
// A corner of a triangle that belongs to this triangle alone, so that each fragment knows how far the sides are.
#include "marching_cubes/mesh.glsl"

in int in_index;

out vec3 v_corner;

void main() {
    int corner = gl_VertexID % 3;
    v_corner = vec3(corner == 0, corner == 1, corner == 2);
    fetch_vertex(in_index);
}
