// What colours, opacities and sizes are over a life.
// vec4 over_life(float over, int row): from viewer/engine/particles/life_table.py; row 0 holds size and opacity.
// vec3 life_color(float over, int generation): linear light.
// vec3 own_shade(vec3 color, uint identity, float kin): turned in hue as its whole family is, and made brighter or
// darker by its own chance. `kin` is the fraction of the w in u_launch, which children have from their parents.
#include "particles/random.glsl"

uniform sampler2D u_table;
uniform vec2 u_hue;                 // degrees
uniform vec2 u_brightness;

vec4 over_life(float over, int row) {
    int last = textureSize(u_table, 0).x - 1;
    float place = clamp(over, 0.0, 1.0) * float(last);
    int step = min(int(place), last - 1);
    vec4 before = texelFetch(u_table, ivec2(step, row), 0), after = texelFetch(u_table, ivec2(step + 1, row), 0);
    return mix(before, after, place - float(step));
}

vec3 life_color(float over, int generation) {
    return over_life(over, 1 + clamp(generation, 0, 3)).rgb;
}

// Turned about the axis of greys, by Rodrigues' formula.
vec3 with_hue(vec3 color, float angle) {
    float grey = dot(color, vec3(1.0 / 3.0));
    vec3 across = (color.zxy - color.yzx) * 0.57735027;
    return max(vec3(grey) + (color - grey) * cos(angle) + across * sin(angle), 0.0);
}

vec3 own_shade(vec3 color, uint identity, float kin) {
    if (u_hue != vec2(0.0))
        color = with_hue(color, radians(mix(u_hue.x, u_hue.y, kin)));
    return color * mix(u_brightness.x, u_brightness.y, random_of(identity, 62u));
}
