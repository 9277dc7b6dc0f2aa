#version 330 core
// One corner of a ribbon: the middle of one of its points, moved to one side.
#include "generated/ribbon.glsl"

uniform sampler2D u_middle;         // in clip space
uniform sampler2D u_side;           // from there to an edge, in clip space; z: so many pixels; w: how far along
uniform sampler2D u_light;

out vec4 v_across;                  // -1 to 1, times y, which keeps it straight where a ribbon tapers; z: half its
                                    // pixels; w: how far along from its start
out vec4 v_light;

void main() {
    int slot = gl_VertexID / (2 * RIBBON_POINTS);
    int corner = gl_VertexID - slot * 2 * RIBBON_POINTS;
    int point = corner >> 1;
    float across = float(2 * (corner & 1) - 1);
    ivec2 texel = ivec2(slot % RIBBON_SIZE.x, slot / RIBBON_SIZE.x)
                + RIBBON_SIZE * ivec2(point % RIBBON_COLUMNS, point / RIBBON_COLUMNS);
    vec4 middle = texelFetch(u_middle, texel, 0);
    vec4 side = texelFetch(u_side, texel, 0);
    v_light = texelFetch(u_light, texel, 0);
    v_across = vec4(across * side.z, side.zzw);
    gl_Position = vec4(middle.xy + across * side.xy, middle.zw);
}
