// The surface's vertices, kept in textures, and where the scene puts them in the world.
// void fetch_vertex(int index): fills v_place, v_normal, v_bend and sets gl_Position.
#include "lib/frame.glsl"
#include "lib/grid.glsl"

uniform int u_slice;                  // 0 none, 1 x, 2 y, 3 z: what lies beyond the slice is cut away
uniform float u_slice_at;             // -1 to 1
uniform vec3 u_slice_reach;           // half the size of the grid
uniform sampler2D u_places;           // in the field's own space
uniform sampler2D u_normals;          // and the mean curvature
uniform vec3 u_world_middle;          // the place that comes to stand at u_world_offset
uniform vec3 u_world_offset;
uniform float u_world_scale;

out vec3 v_place;
out vec3 v_position;
out vec3 v_normal;
out float v_bend;

void fetch_vertex(int index) {
    ivec2 texel = ivec2(index & 1023, index >> 10);
    v_place = texelFetch(u_places, texel, 0).xyz;
    vec4 normal = texelFetch(u_normals, texel, 0);
    v_position = (v_place - u_world_middle) * u_world_scale + u_world_offset;
    v_normal = normal.xyz;
    v_bend = normal.w;
    vec3 from_middle = v_place - (u_grid_corner + u_slice_reach);
    gl_ClipDistance[0] = u_slice == 0 ? 1.0 : u_slice_at * u_slice_reach[u_slice - 1] - from_middle[u_slice - 1];
    gl_Position = u_frame.view_projection * vec4(v_position, 1.0);
}
