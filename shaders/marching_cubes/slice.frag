#version 330 core
// The samples nearest to the plane, each a square of its colour; hatched where there is no value.
#include "lib/frame.glsl"
#include "lib/color.glsl"
#include "lib/grid.glsl"
#include "lib/number.glsl"

uniform sampler2D u_values;
uniform float u_surface_level;
uniform float u_slice_range;

in vec3 v_place;

out vec4 out_color;

void main() {
    vec3 s = (v_place - u_grid_corner) / u_grid_step;
    ivec3 nearest = clamp(ivec3(floor(s + 0.5)), ivec3(0), u_grid_samples - 1);
    float value = texelFetch(u_values, grid_texel(nearest), 0).r - u_surface_level;
    vec3 color = viridis(0.5 + 0.5 * value / u_slice_range);
    color *= value < 0.0 ? 1.0 : 0.86;                 // so that the sides can be told apart at the level too
    if (!is_finite(value))
        color = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0) < 5.0 ? vec3(0.55, 0.12, 0.32) : vec3(0.12);
    out_color = vec4(0.9 * color, 1.0);
}
