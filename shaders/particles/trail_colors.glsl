// What colours, opacities and sizes are over a life.
// vec4 life_color(float part, int generation): linear rgb, and opacity; part: 0 at birth to 1 at death.
// float life_size(float part): of the particle's size.
// vec3 own_shade(vec3 color, uint identity): turned in hue and made brighter or darker by the particle's own chance.
#include "particles/random.glsl"

uniform sampler2D u_table;          // see viewer/engine/particles/life_table.py
uniform vec2 u_hue;                 // degrees
uniform vec2 u_brightness;

vec4 life_row(float part, int row) {
    float place = clamp(part, 0.0, 1.0) * float(textureSize(u_table, 0).x - 1);
    int step = int(place), last = textureSize(u_table, 0).x - 1;
    vec4 before = texelFetch(u_table, ivec2(step, row), 0);
    return mix(before, texelFetch(u_table, ivec2(min(step + 1, last), row), 0), place - float(step));
}

vec4 life_color(float part, int generation) {
    return vec4(life_row(part, 1 + clamp(generation, 0, 3)).rgb, life_row(part, 0).g);
}

float life_size(float part) {
    return life_row(part, 0).r;
}

// Turned about the axis of greys, by Rodrigues' formula.
vec3 turned_hue(vec3 color, float angle) {
    float grey = dot(color, vec3(1.0 / 3.0));
    vec3 across = (color.zxy - color.yzx) * 0.57735027;
    return max(vec3(grey) + (color - grey) * cos(angle) + across * sin(angle), 0.0);
}

vec3 own_shade(vec3 color, uint identity) {
    vec3 shade = turned_hue(color, radians(mix(u_hue.x, u_hue.y, random_of(identity, 61u))));
    return shade * mix(u_brightness.x, u_brightness.y, random_of(identity, 62u));
}
