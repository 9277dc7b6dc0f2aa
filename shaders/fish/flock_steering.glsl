// How a fish gets its way: what it wants by itself, the wall of the tank, and how fast it can be, turn and climb.
// vec3 own_wish(vec3 velocity, float size, float will): an acceleration, in m/s^2.
// vec3 steered(vec3 place, vec3 velocity, vec3 wish, float will): the velocity after the step.
// vec3 kept_inside(vec3 place): the place, or the nearest way back into the tank.

uniform float u_seconds;                // scene time
uniform float u_step;                   // seconds
uniform float u_school_wander;
uniform float u_school_slowest;
uniform float u_school_agility;
uniform float u_steepest;               // rise over run
uniform float u_school_turn;            // radians for each body length

float cruising() {
    return 0.5 * (u_school_slowest + u_school_fastest);
}

vec3 unit(vec3 v) {
    return v / max(length(v), 1e-9);
}

vec3 limited(vec3 v, float most) {
    return v * min(1.0, most / max(length(v), 1e-9));
}

vec3 left_of(vec3 velocity) {
    return unit(vec3(velocity.z, 0.0, -velocity.x));
}

vec3 own_wish(vec3 velocity, float size, float will) {
    float speed = length(velocity);
    float sideways = u_school_wander * 0.5 * (sin(0.7 * u_seconds + will) + sin(1.3 * u_seconds + 3.0 * will));
    sideways += u_school_turn * speed * speed / size;
    vec3 wish = sideways * left_of(velocity) + KEEPING_PACE * (cruising() - speed) / speed * velocity;
    wish.y += u_school_wander * 0.3 * sin(0.9 * u_seconds + 5.0 * will) - LEVELLING * velocity.y;
    return wish;
}

// Towards a velocity along the wall, and a little away from it. Whoever swims straight at it turns to the side that it
// leans to anyway, which is its left for half of all.
vec3 turning_at_wall(vec3 velocity, vec3 outward, float will) {
    vec3 along = velocity - dot(velocity, outward) * outward;
    along += 0.1 * length(velocity) * sign(sin(will)) * left_of(velocity);
    return WALL_TURNING * (length(velocity) * unit(unit(along) - INWARD * outward) - velocity);
}

vec3 steered(vec3 place, vec3 velocity, vec3 wish, float will) {
    vec3 ahead = (place + FORESIGHT * velocity) / u_school_half_axes;
    float urgency = clamp((length(ahead) - WALL_BEGINS) / (1.0 - WALL_BEGINS), 0.0, 1.0);
    vec3 turning = turning_at_wall(velocity, unit(ahead / u_school_half_axes), will);
    vec3 changed = velocity + u_step * mix(limited(wish, u_school_agility),
                                           limited(turning, 2.0 * u_school_agility), urgency);
    float climb = u_steepest * max(length(changed.xz), 1e-4);
    changed.y = clamp(changed.y, -climb, climb);
    return changed * (clamp(length(changed), u_school_slowest, u_school_fastest) / length(changed));
}

vec3 kept_inside(vec3 place) {
    return place / max(length(place / u_school_half_axes), 1.0);
}
