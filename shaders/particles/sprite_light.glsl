// Light on what is round: a ball, or a puff of cloud whose light comes through it.
// vec3 shaded(vec3 normal): how bright it is where the normal, seen from the camera and unturned, points.
#include "lib/lighting.glsl"

// Light wraps around what scatters it (Mitchell, McTaggart and Green, "Shading in Valve's Source Engine", 2006).
float half_lambert(float facing) {
    float wrapped = 0.5 + 0.5 * facing;
    return wrapped * wrapped;
}

vec3 shaded(vec3 normal) {
    if (!SHADED)
        return vec3(1.0);
    vec3 seen = vec3(normal.x * v_axis + normal.y * vec2(-v_axis.y, v_axis.x), normal.z);
    float facing = dot(seen, v_key);
    vec3 own = SPRITE == BALL ? vec3(0.35 + 0.65 * normal.z) : vec3(1.0);
    if (!LIT)
        return own;
    float wrapped = SPRITE == BALL ? max(facing, 0.0) : half_lambert(facing);
    vec3 light = mix(FLOOR_LIGHT, SKY_LIGHT, 0.5 + 0.5 * dot(seen, v_up)) + KEY_LIGHT / PI * wrapped * v_own.x;
    if (SPRITE == BALL)
        light += KEY_LIGHT / PI * v_own.x * glossy_reflection(seen, v_key, vec3(0.0, 0.0, 1.0), 0.3) * max(facing, 0.0);
    return mix(own, light, u_lighting);
}
