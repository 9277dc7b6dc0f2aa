#version 330 core
// A vessel of thin glass: clear where one looks straight through, brighter towards its rim, a highlight on it.
// The colour is what the glass adds, its alpha how much it hides (premultiplied).
#include "lib/lighting.glsl"

uniform vec3 u_color;           // linear

in vec3 v_position;
in vec3 v_normal;

out vec4 out_color;

void main() {
    vec3 to_eye = normalize(u_frame.eye - v_position);
    vec3 normal = normalize(v_normal) * (gl_FrontFacing ? 1.0 : -1.0);
    float facing = clamp(dot(normal, to_eye), 0.0, 1.0);
    float away = 1.0 - facing;
    float mirrored = 0.04 + 0.96 * away * away * away * away * away;    // Schlick 1994
    float coloured = 0.10 + 0.25 * away * away;         // the longer the way through the glass, the more of it
    vec3 around = mix(FLOOR_LIGHT, SKY_LIGHT, 0.5 + 0.5 * reflect(-to_eye, normal).y);
    float highlight = 0.0;
    if (gl_FrontFacing)
        highlight = max(dot(normal, u_frame.key_direction), 0.0)
                  * min(glossy_reflection(normal, u_frame.key_direction, to_eye, 0.18), 4.0);
    vec3 light = (1.0 - mirrored) * coloured * u_color * SKY_LIGHT + mirrored * 1.6 * around + highlight * KEY_LIGHT;
    out_color = vec4(light, 1.0 - (1.0 - mirrored) * (1.0 - coloured));
}
