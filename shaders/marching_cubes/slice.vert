#version 330 core
// A plane through the grid, at right angles to an axis.
#include "lib/frame.glsl"
#include "lib/grid.glsl"

uniform int u_slice;                  // 1 x, 2 y, 3 z
uniform float u_slice_at;
uniform vec3 u_slice_reach;
uniform vec3 u_world_middle;
uniform vec3 u_world_offset;
uniform float u_world_scale;

out vec3 v_place;

void main() {
    vec2 corner = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
    vec3 unit = u_slice == 1 ? vec3(u_slice_at, corner) : u_slice == 2 ? vec3(corner.x, u_slice_at, corner.y)
                                                                      : vec3(corner, u_slice_at);
    v_place = u_grid_corner + (1.0 + unit) * u_slice_reach;
    vec3 position = (v_place - u_world_middle) * u_world_scale + u_world_offset;
    gl_Position = u_frame.view_projection * vec4(position, 1.0);
}
