#version 330 core
// One point of a moving particle's trail: the first is where the particle is, the last where the trail ends.
#include "generated/trail.glsl"
#include "particles/paths.glsl"
#include "particles/ribbon.glsl"
#include "particles/fibre.glsl"

uniform sampler2D u_motion;
uniform sampler2D u_end, u_reach, u_tint;           // see trail_reach.frag
uniform int u_newest;
uniform float u_trail_taper;

const float THINNEST = 1.6;         // pixels: what is thinner is drawn so wide, but paler

vec4 trail_point(ivec2 slot, int point, vec4 end, vec4 reach) {
    if (point > int(end.w))
        return vec4(end.xyz, reach.y);
    if (point == 0)
        return vec4(texelFetch(u_motion, slot, 0).xyz, 0.0);
    int block = u_newest - point + 1;
    vec4 found = path_point(slot, block < 0 ? block + PATH_POINTS : block);
    return vec4(found.xyz, reach.x - found.w);
}

void main() {
    ivec2 slot;
    int point;
    ribbon_point(slot, point);
    vec4 end = texelFetch(u_end, slot, 0), reach = texelFetch(u_reach, slot, 0), tint = texelFetch(u_tint, slot, 0);
    point = min(point, int(end.w) + 1);
    vec4 here = trail_point(slot, point, end, reach);
    vec3 newer = trail_point(slot, max(point - 1, 0), end, reach).xyz;
    vec3 older = trail_point(slot, point + 1, end, reach).xyz;

    float back = clamp(here.w / max(reach.y, 1e-9), 0.0, 1.0);
    float pixel = pixel_size(here.xyz, u_frame.resolution);
    float half_width = reach.z * mix(1.0, 1.0 - back, u_trail_taper);
    float drawn = reach.z > 0.0 ? widened(half_width, here.xyz, THINNEST, pixel) : 0.0;
    float opacity = tint.a * (1.0 - back) * min(1.0, half_width / max(drawn, 1e-9));
    vec3 light = tint.rgb;
    if (HIDES) {
        vec3 way = newer - older;
        vec3 along = way / max(length(way), 1e-9);
        light *= thin_cylinder(here.xyz, along);
    }
    ribbon_seen(newer, here.xyz, older, drawn, pixel, here.w / max(reach.z, 1e-9));
    out_light = vec4(min(light, 30000.0) * opacity, HIDES ? opacity : 0.0);
}
