// What happens where a particle meets a collider.
// Impact met(inout vec3 place, inout vec3 velocity, vec3 acceleration, float rate, float duration): moves a
// particle through a step and off whatever it runs into, and says what happened.
//
// The time of impact is solved for: the path is closed in by the step's two ends, one outside and one inside, a step
// of the secant method comes near, and the parabola through all three tells where the distance is zero (Muller 1956);
// over a plane it is exact. Clamping and flipping instead would cost a fifth of a bounce's height.
#include "particles/path.glsl"
#include "particles/collider.glsl"

uniform float u_restitution;
uniform float u_friction;
uniform float u_step;                   // a whole step, in seconds
uniform float u_thinnest;               // how thin the thinnest collider is, in metres

struct Impact {
    bool struck;                        // it hit something, and not as what lies on it does
    bool touched;                       // it hit or lies on something
    float moment;                       // when, in seconds since the start
};

// Where along the path p + t (v + t b) the obstacle may have been entered, too thin to be sure to hold the end: a time
// outside and one inside, or where it was not, 0 and how far the path was followed. Safe strides as in sphere tracing
// (Hart 1996), but never shorter than half its thickness. (The ground has no far side: there the end tells.)
vec2 entered(vec3 p, vec3 v, vec3 b, float duration) {
    float speed = length(v) + 2.0 * duration * length(b) + 1e-9;
    float outside = 0.0, clear = obstacle_distance(p);
    for (int probe = 0; probe < MOST_PROBES; ++probe) {
        float next = min(outside + max(clear, 0.5 * u_thinnest) / speed, duration);
        clear = obstacle_distance(p + next * (v + next * b));
        if (clear < 0.0)
            return vec2(outside, next);
        outside = next;
        if (outside >= duration)
            break;
    }
    return vec2(0.0, outside);
}

// How much of the duration passes before the obstacle is entered, if it is.
float followed(vec3 p, vec3 v, vec3 b, float duration) {
    vec2 span = entered(p, v, b, duration);
    bool inside = obstacle_distance(p + span.y * (v + span.y * b)) < 0.0;
    return inside ? span.x : span.y;
}

// Coulomb's law for the velocity along the surface: friction takes away at most what there is.
vec3 rubbed(vec3 along, float pressed) {
    return along * max(0.0, 1.0 - u_friction * pressed / max(length(along), 1e-9));
}

// Where between span.x and span.y the parabola through three distances is zero: d.x at span.x, at least 0, d.z at
// span.y, below 0, and d.y at the time t in between.
float crossing(vec2 span, float t, vec3 d) {
    float before = min(span.x - t, -1e-9), after = max(span.y - t, 1e-9);
    float falling = (d.z - d.y) / after;
    float bend = (falling - (d.x - d.y) / before) / (after - before);
    float slope = falling - bend * after;
    float root = sqrt(max(0.0, slope * slope - 4.0 * bend * d.y));
    return clamp(t + 2.0 * d.y / max(root - slope, 1e-20), span.x, span.y);
}

// Leave a surface of normal n with a velocity v after an impact; what would bounce for less than a step stays on it
// for what is `left` of the step, while a pulls it along.
vec3 bounced(vec3 v, vec3 n, vec3 a, float left, out bool stays) {
    float inward = max(0.0, -dot(v, n));
    float outward = u_restitution * inward;
    float pull = max(0.0, -dot(a, n));
    stays = 2.0 * outward < pull * u_step;
    vec3 along = v - dot(v, n) * n;
    vec3 staying = rubbed(along + left * (a - dot(a, n) * n), inward + left * pull);
    return stays ? staying : rubbed(along, inward + outward) + outward * n;
}

Impact met(inout vec3 place, inout vec3 velocity, vec3 acceleration, float rate, float duration) {
    vec3 p = place, v = velocity, a = acceleration;
    vec2 damp = HAS_DRAG ? damping(rate * duration) : vec2(1.0, 0.5);
    vec3 begun = HAS_DRAG ? a - rate * v : a;       // the acceleration at the start, drag included
    vec3 b = damp.y * begun;                        // the path as p + t (v + t b)
    vec3 gain = damp.x * begun;                     // the velocity as v + t gain; both are exact at the end
    vec3 end = p + duration * (v + duration * b);
    vec3 leaving = v + duration * gain;
    Impact impact = Impact(false, false, duration);
    place = end;
    velocity = leaving;
    if (!HAS_COLLIDER)
        return impact;

    vec2 span = vec2(0.0, duration);
    if (MAY_PASS_THROUGH) {
        span = entered(p, v, b, duration);
        vec3 before = p + span.x * (v + span.x * b);
        if (HAS_GROUND && ground_distance(before) < 0.0)        // the ground came first
            span = vec2(0.0, span.x);
        end = p + span.y * (v + span.y * b);
        place = end;
        velocity = v + span.y * gain;
    }
    float distance_in = collider_distance(end);
    if (distance_in >= 0.0)
        return impact;

    float distance_out = max(collider_distance(p + span.x * (v + span.x * b)), 0.0);
    float t = span.x + (span.y - span.x) * distance_out / max(distance_out - distance_in, 1e-20);
    float near = collider_distance(p + t * (v + t * b));
    t = crossing(span, t, vec3(distance_out, near, distance_in));

    vec3 hit = p + t * (v + t * b);
    vec3 arriving = v + t * gain;
    vec3 n = collider_normal(hit);
    float left = duration - t;
    bool stays;
    vec3 u = bounced(arriving, n, a, left, stays);
    impact.struck = -dot(arriving, n) > 2.0 * max(0.0, -dot(a, n)) * u_step;
    impact.touched = true;
    impact.moment = t;
    if (ON_COLLISION != COLLISION_BOUNCE) {
        place = hit + max(0.0, collider_clearance(hit) - collider_distance(hit)) * n;
        velocity = vec3(0.0);
        return impact;
    }

    vec3 along = arriving - dot(arriving, n) * n;
    if (MAY_PASS_THROUGH && !stays)     // nor through anything on the way off
        left = followed(hit + collider_clearance(hit) * n, u, 0.5 * a, left);
    place = hit + left * (stays ? 0.5 * (along + u) : u + 0.5 * left * a);
    place += max(0.0, collider_clearance(place) - collider_distance(place)) * collider_normal(place);
    bool lies = stays && dot(u, u) == 0.0 && span.x == 0.0 && distance_out < 2.0 * collider_clearance(p);
    if (lies || collider_distance(place) < 0.0)     // or a corner: stay where it was free
        place = p;
    u += stays ? vec3(0.0) : left * a;
    // Nothing that only pushes can add energy: what the push out of the surface lifted is paid for with speed.
    float allowed = max(0.0, dot(v, v) + 2.0 * dot(a, place - p));
    velocity = u * min(1.0, sqrt(allowed / max(dot(u, u), 1e-20)));
    return impact;
}
