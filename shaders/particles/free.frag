#version 330 core
// Where a collider was moved or has grown, whoever is inside now is pushed out of it; who cannot get out dies.
#include "particles/collider.glsl"

uniform sampler2D u_motion, u_velocity;     // see step.frag

layout(location = 0) out vec4 out_motion;
layout(location = 1) out vec4 out_velocity;
layout(location = 2) out uint out_status;

const int MOST_PUSHES = 16;                 // between two colliders it takes several
const float LAST_MOMENT = 1e-6;             // seconds

void main() {
    ivec2 slot = ivec2(gl_FragCoord.xy);
    vec4 motion = texelFetch(u_motion, slot, 0);
    vec3 place = motion.xyz;
    bool inside = HAS_COLLIDER && collider_distance(place) < 0.0;
    for (int push = 0; push < MOST_PUSHES; ++push)
        if (collider_distance(place) < 0.0)
            place += (collider_clearance(place) - collider_distance(place)) * collider_normal(place);
    bool caught = inside && collider_distance(place) < 0.0;
    out_motion = inside ? vec4(place, caught ? min(motion.w, LAST_MOMENT) : motion.w) : motion;
    out_velocity = texelFetch(u_velocity, slot, 0);
    out_status = motion.w > 0.0 ? 1u : 0u;
}
