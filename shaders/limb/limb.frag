#version 330 core
// The skin: a checkered pattern, by which the eye sees a twist, the model's own colours, or a bone's weights.
#include "lib/lighting.glsl"
#include "lib/color.glsl"

const int CHECKERED = 0, OWN = 1, WEIGHTS = 2, PLAIN = 3;

uniform int u_skin_shown;
uniform vec4 u_base_color;        // linear
uniform bool u_has_texture;
uniform sampler2D u_texture;
uniform float u_roughness;
uniform bool u_pale;              // behind bones that are to be seen
uniform float u_checks;           // how many for each unit of texture coordinates
uniform int u_stripe_every;       // every how many columns of the pattern one is painted as a stripe

in vec3 v_position;
in vec3 v_normal;
in vec2 v_texcoord;
in float v_weight;

out vec4 out_color;

const vec3 PAPER = vec3(0.90, 0.87, 0.81);
const vec3 BRICK = vec3(0.78, 0.33, 0.22);
const vec3 STRIPE = vec3(0.10, 0.30, 0.52);

// A square wave of t, its steps as wide as a pixel: the difference of its integral over that width.
float checked_wave(float t, float width) {
    vec2 ends = vec2(t - 0.5 * width, t + 0.5 * width);
    vec2 area = abs(2.0 * fract(0.5 * ends) - 1.0);
    return clamp((area.x - area.y) / max(width, 1e-6), -1.0, 1.0);
}

vec3 checkers() {
    vec2 place = u_checks * v_texcoord;
    vec2 width = max(fwidth(place), 1e-4);
    float parity = checked_wave(place.x, width.x) * checked_wave(place.y, width.y);
    float column = mod(floor(place.x), float(u_stripe_every));
    vec3 dark = column < 1.0 ? STRIPE : BRICK;
    float far = smoothstep(0.6, 1.4, max(width.x, width.y));      // where checks are smaller than a pixel
    return linear_light(mix(dark, PAPER, mix(0.5 + 0.5 * parity, 0.5, far)));
}

void main() {
    vec3 normal = normalize(v_normal) * (gl_FrontFacing ? 1.0 : -1.0);
    vec3 color = u_skin_shown == PLAIN ? vec3(0.62, 0.56, 0.50) : u_base_color.rgb;
    if (u_skin_shown == OWN && u_has_texture)
        color *= linear_light(texture(u_texture, v_texcoord).rgb);
    if (u_skin_shown == CHECKERED)
        color = checkers();
    if (u_skin_shown == WEIGHTS)
        color = viridis(v_weight);
    if (u_pale)
        color = mix(color, vec3(0.5 * dot(color, vec3(0.3, 0.5, 0.2)) + 0.2), 0.6);
    out_color = vec4(studio_light(v_position, normal, color, u_roughness), 1.0);
}
