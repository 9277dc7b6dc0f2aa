#version 330 core
// A vertex of the surface, by its number in the mesh.
#include "marching_cubes/mesh.glsl"

out vec3 v_corner;

void main() {
    v_corner = vec3(1.0);             // no wire
    fetch_vertex(gl_VertexID);
}
