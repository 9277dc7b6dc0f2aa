// A particle's colour: by its age and its own chance, or telling of something, and in the light where it is.
// vec4 tint(vec3 place, vec3 normal, Qualities of, float opacity, out float reaching): linear light where it is
// opaque, and its opacity; `reaching` is how much of the key light reaches it.
#include "lib/lighting.glsl"
#include "particles/life_color.glsl"
#include "particles/telling_color.glsl"

uniform float u_glow;
uniform float u_lighting;

const float BRIGHTEST = 30000.0;    // half floats hold twice as much

// Light that comes from a flat, thin thing: part of it shines through from behind. What is round and translucent,
// with no side of its own, scatters as much whichever way it is lit.
vec3 light_on(vec3 place, vec3 normal, float reaching) {
    float facing = 0.7, height = 0.5;
    if (BILLBOARD == TUMBLES) {
        vec3 towards_eye = dot(normal, u_frame.eye - place) < 0.0 ? -normal : normal;
        float lit = dot(towards_eye, u_frame.key_direction);
        facing = lit > 0.0 ? lit : -0.55 * lit;
        height = 0.5 + 0.5 * towards_eye.y;
    }
    return mix(FLOOR_LIGHT, SKY_LIGHT, height) + 0.4 * FILL_LIGHT + KEY_LIGHT / PI * facing * reaching;
}

vec4 tint(vec3 place, vec3 normal, Qualities of, float opacity, out float reaching) {
    reaching = 1.0;
    opacity = clamp(opacity, 0.0, 1.0);
    if (COLOURING != BY_LOOK)
        return vec4(telling_color(of), opacity);
    vec3 color = own_shade(life_color(of.over, of.generation), of.identity, of.kin);
    if (LIT) {
        reaching = key_light_on_surface(place + 0.5 * of.diameter * u_frame.key_direction, u_frame.key_direction);
        if (SPRITE != BALL && SPRITE != PUFF)       // those are lit pixel by pixel
            color *= mix(vec3(1.0), light_on(place, normal, reaching), u_lighting);
    }
    return vec4(min(u_glow * color, BRIGHTEST), opacity);
}
