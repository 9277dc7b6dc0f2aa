#version 330 core
// The spine now in blue between light edges, earlier ones pale, the envelope in dark dashes.
#include "lib/color.glsl"

uniform int u_ghosts;

in float v_along;
in float v_across;
flat in int v_line;

out vec4 out_color;

void main() {
    if (v_line == 0)
        out_color = vec4(mix(okabe_ito(5), vec3(0.9), smoothstep(0.62, 0.78, abs(v_across))), 1.0);
    else if (v_line <= 2)
        out_color = vec4(vec3(0.02), fract(24.0 * v_along) < 0.6 ? 0.9 : 0.0);
    else
        out_color = vec4(vec3(0.9), 0.50 * (1.0 - float(v_line - 2) / float(u_ghosts + 1)) + 0.08);
}
