#version 330 core
// One step of every particle: forces, then the path with what it runs into, then age.
// A particle lives while it has seconds left; one that is stuck has a negative identity.
#include "generated/step.glsl"
#include "lib/number.glsl"
#include "particles/forces.glsl"
#include "particles/contact.glsl"
#include "particles/cascade.glsl"

uniform sampler2D u_motion;             // xyz place, w seconds left to live
uniform sampler2D u_velocity;           // xyz velocity, w identity
uniform sampler2D u_nature;             // lifetime, size, mass, drag
uniform sampler2D u_origin;             // xyz birthplace, w how much of its first step it lives
uniform sampler2D u_launch;             // xyz velocity at birth, w generation
uniform float u_common_mass;            // where all have the same
uniform float u_common_drag;

layout(location = 0) out vec4 out_motion;
layout(location = 1) out vec4 out_velocity;
layout(location = 2) out uint out_status;   // bit 0 lives, bit 1 has just died, bit 2 has struck; above, its children

void main() {
    ivec2 slot = ivec2(gl_FragCoord.xy);
    vec4 motion = texelFetch(u_motion, slot, 0);
    vec4 velocity = texelFetch(u_velocity, slot, 0);
    float mass = u_common_mass, drag = u_common_drag, step_seconds = u_step;
    if (VARIED) {
        vec4 nature = texelFetch(u_nature, slot, 0);
        mass = nature.z;
        drag = nature.w;
    }
    if (NEWBORN)
        step_seconds = texelFetch(u_origin, slot, 0).w;

    bool lives = motion.w > 0.0;
    float duration = clamp(motion.w, 0.0, step_seconds);
    vec3 place = motion.xyz, now = velocity.xyz;
    vec3 midway = FORCES_VARY ? place + 0.5 * duration * now : place;
    vec3 acceleration = force_acceleration(midway, mass);
    float rate = drag / mass;
    if (HAS_DRAG && HAS_WIND)
        acceleration += rate * air_velocity(midway);
    Impact impact = met(place, now, acceleration, rate, duration);

    float left = motion.w - step_seconds;
    float identity = abs(velocity.w);
    bool stuck = false;
    if (HAS_COLLIDER && ON_COLLISION == COLLISION_STICK) {
        stuck = velocity.w < 0.0 || impact.touched;
        if (velocity.w < 0.0) {
            place = motion.xyz;
            now = vec3(0.0);
            impact.struck = false;
        }
    }
    if (HAS_COLLIDER && ON_COLLISION == COLLISION_DIE && impact.touched)
        left = 0.0;
    if (!is_finite(dot(place, place) + dot(now, now))) {    // beyond what numbers hold: gone
        place = motion.xyz;
        now = vec3(0.0);
        left = 0.0;
    }
    bool died = lives && left <= 0.0;
    int children = 0;
    if (CASCADES && lives)
        children = brood(int(texelFetch(u_launch, slot, 0).w), uint(identity), motion.w,
                         max(0.0, motion.w - (ON_COLLISION == COLLISION_DIE ? impact.moment : duration)),
                         impact.struck, died);
    out_motion = lives ? vec4(place, max(left, 0.0)) : motion;
    out_velocity = lives ? vec4(now, stuck ? -identity : identity) : velocity;
    out_status = lives ? (died ? 2u : 1u) | (impact.struck ? 4u : 0u) | uint(children) << 3u : 0u;
}
