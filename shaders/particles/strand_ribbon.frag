#version 330 core
// One point of a strand, from its root, the first, to its tip.
#include "generated/strand.glsl"
#include "particles/paths.glsl"
#include "particles/ribbon.glsl"
#include "particles/life_color.glsl"
#include "particles/fibre.glsl"

uniform sampler2D u_launch;
uniform sampler2D u_end, u_reach, u_tint;           // see strand_reach.frag
uniform float u_trail_taper, u_shine, u_shine_sharpness, u_root_shade;

vec4 strand_point(ivec2 slot, int point, vec4 end, vec4 reach) {
    return point > int(end.w) ? vec4(end.xyz, reach.x) : path_point(slot, max(point, 0));
}

void main() {
    ivec2 slot;
    int point;
    ribbon_point(slot, point);
    vec4 end = texelFetch(u_end, slot, 0), reach = texelFetch(u_reach, slot, 0);
    point = min(point * POINTS_APART, int(end.w) + 1);
    vec4 here = strand_point(slot, point, end, reach);
    vec3 before = strand_point(slot, max(point - POINTS_APART, 0), end, reach).xyz;
    vec3 after = strand_point(slot, point + POINTS_APART, end, reach).xyz;

    float up = clamp(here.w / max(reach.x, 1e-9), 0.0, 1.0);
    float pixel = pixel_size(here.xyz, CASTING ? vec2(SHADOW_PIXELS) : u_frame.resolution);
    float half_width = reach.y * mix(1.0, 1.0 - up, u_trail_taper);
    float drawn = widened(half_width, here.xyz, THINNEST, pixel);
    // Where strands are thinner than that, some of them end, each by its own chance, so that the same share of the
    // picture is covered. (Alpha to coverage would give all the same samples: together they would never hide a thing.)
    drawn *= reach.z * drawn < half_width ? 1.0 : 0.0;
    ribbon_seen(before, here.xyz, after, drawn, pixel, up);
    out_light = vec4(0.0, 0.0, 0.0, 1.0);
    if (!CASTING) {
        vec3 way = after - before;
        vec3 along = way / max(length(way), 1e-9);
        vec4 launch = texelFetch(u_launch, slot, 0);
        vec3 out_of = launch.xyz / max(length(launch.xyz), 1e-9);
        vec3 albedo = min(life_color(up, int(launch.w)) * texelFetch(u_tint, slot, 0).rgb, 1.0);
        float open = mix(1.0 - u_root_shade, 1.0, smoothstep(0.0, 0.8, up));
        out_light = vec4(hair_light(here.xyz, along, out_of, albedo, u_shine, u_shine_sharpness, open), 1.0);
    }
}
