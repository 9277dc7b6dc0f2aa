#version 330 core
// Lit by the normal, or coloured by it, or by how wrong it is. Right of the wipe: the exact normal.
#include "lib/lighting.glsl"
#include "lib/color.glsl"

uniform int u_colouring;          // 0 surface, 1 normal, 2 error
uniform vec3 u_color;
uniform float u_error_scale;      // the error, in degrees, at the top of the colour map
uniform float u_wipe;             // the share of the picture, from the right, with exact normals

in vec3 v_position;
in vec3 v_normal;
in vec3 v_exact_normal;

out vec4 out_color;

void main() {
    float from_wipe = gl_FragCoord.x - (1.0 - u_wipe) * u_frame.resolution.x;
    vec3 exact = normalize(v_exact_normal);
    vec3 normal = from_wipe > 0.0 ? exact : normalize(v_normal);
    vec3 color = studio_light(v_position, normal, u_color, 0.35);
    if (u_colouring == 1)
        color = linear_light(0.5 + 0.5 * normal);
    if (u_colouring == 2) {
        float degrees_off = degrees(atan(length(cross(normal, exact)), dot(normal, exact)));
        color = viridis(degrees_off / u_error_scale);
    }
    if (u_wipe > 0.0 && u_wipe < 1.0 && abs(from_wipe) < 0.0012 * u_frame.resolution.x)
        color = vec3(0.02);
    out_color = vec4(color, 1.0);
}
