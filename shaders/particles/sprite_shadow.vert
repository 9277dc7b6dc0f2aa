#version 330 core
// A particle as the key light sees it: a disc, drawn as a point. Where there are very many, each stands for several.
#include "generated/look.glsl"
#include "generated/sprite_shadow.glsl"
#include "particles/sprite_kinds.glsl"
#include "lib/frame.glsl"
#include "particles/random.glsl"

uniform sampler2D u_motion, u_velocity, u_nature, u_table;
uniform int u_each_stands_for;
uniform float u_map_size;           // of the shadow map, in pixels
uniform float u_opacity;

flat out float v_density;           // the chance that light is stopped in the middle of the disc
flat out uint v_identity;

void main() {
    int number = gl_VertexID * u_each_stands_for;
    ivec2 slot = ivec2(number & WIDTH_MASK, number >> WIDTH_BITS);
    vec4 motion = texelFetch(u_motion, slot, 0);
    vec4 nature = texelFetch(u_nature, slot, 0);
    float over = clamp(1.0 - motion.w / max(nature.x, 1e-6), 0.0, 1.0);
    vec2 size_and_opacity = texelFetch(u_table, ivec2(over * float(textureSize(u_table, 0).x - 1) + 0.5, 0), 0).xy;
    float area = size_and_opacity.x * nature.y * 0.5 * u_frame.projection[1][1] * u_map_size;
    area *= area * float(u_each_stands_for);

    v_identity = uint(abs(texelFetch(u_velocity, slot, 0).w));
    v_density = u_opacity * size_and_opacity.y * min(area, 1.0) * 2.0 * AREAS[SPRITE] / AREAS[BALL];
    gl_PointSize = clamp(sqrt(area), 1.0, 250.0);
    bool stops_light = motion.w > 0.0 && v_density > 0.0;
    gl_Position = stops_light ? u_frame.view_projection * vec4(motion.xyz, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
