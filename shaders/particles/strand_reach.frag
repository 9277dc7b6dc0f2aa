#version 330 core
// Where each strand ends: at the end of the particle's life, or where it is long enough.
#include "particles/paths.glsl"
#include "particles/life_color.glsl"

uniform sampler2D u_motion, u_velocity, u_nature, u_launch;     // see step.frag
uniform float u_trail_length, u_trail_width, u_tint_variation;

layout(location = 0) out vec4 out_end;      // where, and how many points it has before
layout(location = 1) out vec4 out_reach;    // its length, half its width, and its chance to be seen from afar
layout(location = 2) out vec4 out_light;    // what its colour is multiplied by

const int HALVINGS = 6;

void main() {
    ivec2 slot = ivec2(gl_FragCoord.xy);
    vec4 nature = texelFetch(u_nature, slot, 0);
    uint identity = uint(abs(texelFetch(u_velocity, slot, 0).w));
    float whole = path_point(slot, PATH_POINTS - 1).w;
    float extent = u_trail_length > 0.0 ? min(u_trail_length, whole) : whole;
    int last = 0, beyond = PATH_POINTS - 1;
    for (int step = 0; step < HALVINGS; ++step) {
        int middle = (last + beyond + 1) / 2;
        bool near = path_point(slot, middle).w <= extent;
        last = near ? middle : last;
        beyond = near ? beyond : middle - 1;
    }
    vec4 here = path_point(slot, last), next = path_point(slot, min(last + 1, PATH_POINTS - 1));
    float part = clamp((extent - here.w) / max(next.w - here.w, 1e-9), 0.0, 1.0);
    float lives = texelFetch(u_motion, slot, 0).w > 0.0 ? 1.0 : 0.0;
    float shade = 2.0 * random_of(identity, 63u) - 1.0, warmth = 2.0 * random_of(identity, 64u) - 1.0;
    vec3 tint = exp2(u_tint_variation * (0.9 * shade + 0.35 * warmth * vec3(1.0, 0.1, -1.0)));
    out_end = vec4(mix(here.xyz, next.xyz, part), float(last));
    out_reach = vec4(extent, lives * 0.5 * u_trail_width * nature.y, random_of(identity, 65u), 0.0);
    out_light = vec4(own_shade(tint, identity, fract(texelFetch(u_launch, slot, 0).w)), 1.0);
}
