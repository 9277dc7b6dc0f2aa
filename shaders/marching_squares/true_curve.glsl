// The curve on which the formula itself passes through the level.
// float true_curve_ink(vec2 p, float half_width): how much of a pixel it covers at the place p of the square.
#include "lib/frame.glsl"
#include "generated/formula.glsl"

uniform float u_level;

// The curve passes p at the distance |f - level| / |grad f|, here in pixels. At a pole that is zero too; but there
// Newton's step towards a zero does not lead to smaller values (it leaves a third of them or more), and so no
// line is drawn. p has to vary smoothly over the picture, for its derivatives are taken.
float true_curve_ink(vec2 p, float half_width) {
    vec2 across = dFdx(p), up = dFdy(p);
    float value = formula(vec3(p, 0.0)) - u_level;
    float change = abs(dFdx(value)) + abs(dFdy(value));
    if (abs(value) > 16.0 * half_width * change)
        return 0.0;                                     // far from any curve: spare the gradient
    vec2 slope = formula_gradient(vec3(p, 0.0)).xy;
    float steepness = length(vec2(dot(slope, across), dot(slope, up)));
    float distance_out = abs(value) / steepness;
    vec2 there = p - value * slope / dot(slope, slope);
    bool passes = abs(formula(vec3(there, 0.0)) - u_level) <= 0.31 * abs(value);
    return passes && steepness > 0.0 ? clamp(0.5 + half_width - distance_out, 0.0, 1.0) : 0.0;
}
