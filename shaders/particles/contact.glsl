// What happens where a particle meets a collider.
// Impact met(inout vec3 place, inout vec3 velocity, vec3 acceleration, float rate, float duration): moves a
// particle through a step and off whatever it runs into, and says what happened.
//
// The time of impact is solved for: the path is closed in by the step's two ends, one outside and one inside, and
// two steps of the secant method find where the distance is zero. Clamping and flipping instead would cost a fifth
// of a bounce's height.
#include "particles/path.glsl"
#include "particles/collider.glsl"

uniform float u_restitution;
uniform float u_friction;
uniform float u_step;                   // a whole step, in seconds
uniform float u_thinnest;               // how thin the thinnest collider is, in metres

const int MOST_PROBES = 48;

struct Impact {
    bool struck;                        // it hit something, and not as what lies on it does
    bool touched;                       // it hit or lies on something
    float moment;                       // when, in seconds since the start
};

// Where along the path p + t (v + t b) a thing that is too thin to be sure to hold the end may have been entered:
// times outside and inside. Safe strides as in sphere tracing (Hart 1996), but never shorter than half its thickness.
vec2 entered(vec3 p, vec3 v, vec3 b, float duration) {
    float speed = length(v) + 2.0 * duration * length(b) + 1e-9;
    float outside = 0.0, clear = collider_distance(p);
    for (int probe = 0; probe < MOST_PROBES; ++probe) {
        float next = min(outside + max(clear, 0.5 * u_thinnest) / speed, duration);
        clear = collider_distance(p + next * (v + next * b));
        if (clear < 0.0)
            return vec2(outside, next);
        outside = next;
        if (outside >= duration)
            break;
    }
    return vec2(outside, outside);      // still short of the end: what was not looked at is not entered
}

// Coulomb's law for the velocity along the surface: friction takes away at most what there is.
vec3 rubbed(vec3 along, float pressed) {
    return along * max(0.0, 1.0 - u_friction * pressed / max(length(along), 1e-9));
}

// Leave a surface of normal n with a velocity v after an impact; what would bounce for less than a step lies still.
vec3 bounced(vec3 v, vec3 n, float pull, float left, out bool rests) {
    float inward = max(0.0, -dot(v, n));
    float outward = u_restitution * inward;
    rests = 2.0 * outward < pull * u_step;
    vec3 along = v - dot(v, n) * n;
    return rubbed(along, (1.0 + u_restitution) * inward + (rests ? pull * left : 0.0)) + (rests ? 0.0 : outward) * n;
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
        end = p + span.y * (v + span.y * b);
        place = end;
    }
    float distance_in = collider_distance(end);
    if (distance_in >= 0.0)
        return impact;

    float distance_out = max(collider_distance(p + span.x * (v + span.x * b)), 0.0);
    float t = span.x + (span.y - span.x) * distance_out / max(distance_out - distance_in, 1e-20);
    float near = collider_distance(p + t * (v + t * b));
    span = near > 0.0 ? vec2(t, span.y) : vec2(span.x, t);
    vec2 gap = near > 0.0 ? vec2(near, distance_in) : vec2(distance_out, near);
    t = span.x + (span.y - span.x) * gap.x / max(gap.x - gap.y, 1e-20);

    vec3 hit = p + t * (v + t * b);
    vec3 arriving = v + t * gain;
    vec3 n = collider_normal(hit);
    float left = duration - t;
    float pull = max(0.0, -dot(a, n));
    bool rests;
    vec3 u = bounced(arriving, n, pull, left, rests);
    impact.struck = -dot(arriving, n) > 2.0 * pull * u_step;
    impact.touched = true;
    impact.moment = t;
    if (ON_COLLISION != COLLISION_BOUNCE) {
        place = hit + max(0.0, 1e-6 - collider_distance(hit)) * n;
        velocity = vec3(0.0);
        return impact;
    }

    vec3 pulled = rests ? vec3(0.0) : a;
    place = hit + left * (u + 0.5 * left * pulled);
    place += max(0.0, 1e-6 - collider_distance(place)) * collider_normal(place);
    if (collider_distance(place) < 0.0)         // a corner: stay where it was free
        place = p;
    u += left * pulled;
    // Nothing that only pushes can add energy: what the push out of the surface lifted is paid for with speed.
    float allowed = max(0.0, dot(v, v) + 2.0 * dot(a, place - p));
    velocity = u * min(1.0, sqrt(allowed / max(dot(u, u), 1e-20)));
    return impact;
}
