#version 330 core
// The surface, lit, or coloured by what the lecture wants to show. Its inner side is of another colour.
#include "lib/lighting.glsl"
#include "lib/color.glsl"
#include "lib/grid.glsl"
#include "marching_cubes/cell.glsl"
#include "generated/look.glsl"          // COLOURING, ONE_CASE, WIREFRAME: what is not wanted costs nothing
#include "generated/case_classes.glsl"

const int NORMAL = 1, CURVATURE = 2, CASE = 3, DIFFERENCE = 4;        // 0 is a lit surface

uniform vec3 u_color;
uniform float u_curvature_scale;      // the curvature at the ends of the colours
uniform float u_difference_scale;     // the distance at their bright end, in cells
uniform int u_method_drawn;           // 0 cubes, 1 tetrahedra
uniform int u_case;                   // the case whose cells are shown
uniform bool u_painted_side;          // which side has the colour: true where values are larger

in vec3 v_place;
in vec3 v_position;
in vec3 v_normal;
in float v_bend;
in vec3 v_corner;

out vec4 out_color;

const vec3 INNER = vec3(0.30, 0.36, 0.44);
const vec3 WIRE = vec3(0.015, 0.02, 0.03);

vec3 case_color(int number) {
    int kind = case_classes[number];
    return mix(okabe_ito(1 + kind % 7), vec3(0.8), 0.33 * float(kind / 7));
}

// Where the other method would put the surface, in cells away from here.
float difference(vec3 s) {
    float other = u_method_drawn == 0 ? tetrahedra_value(s) : trilinear_value(s);
    vec3 slope = vec3(0.0);
    for (int axis = 0; axis < 3; axis++) {
        vec3 aside = vec3(0.0);
        aside[axis] = 0.5;
        slope[axis] = trilinear_value(s + aside) - trilinear_value(s - aside);
    }
    return abs(other) / max(length(slope), 1e-30);
}

// How much of a fragment the sides of its triangle cover, about a pixel and a half wide.
float wire_cover() {
    vec3 pixels = v_corner / max(fwidth(v_corner), vec3(1e-9));
    return 1.0 - smoothstep(0.6, 1.5, min(pixels.x, min(pixels.y, pixels.z)));
}

void main() {
    bool larger = gl_FrontFacing, painted = larger == u_painted_side;
    vec3 normal = dot(v_normal, v_normal) > 0.0 ? normalize(v_normal) : normalize(cross(dFdx(v_position), dFdy(v_position)));
    vec3 facing = larger ? normal : -normal;
    vec3 s = (v_place - u_grid_corner) / u_grid_step;
    vec3 paint = painted ? u_color : INNER;
    if (COLOURING == CURVATURE)
        paint = viridis(0.5 + 0.5 * v_bend / u_curvature_scale);
    if (COLOURING == CASE)
        paint = case_color(cell_case(s));
    if (COLOURING == DIFFERENCE)
        paint = viridis(difference(s) / u_difference_scale);
    if (ONE_CASE && cell_case(s) != u_case)
        paint = mix(vec3(dot(paint, vec3(0.33))), vec3(0.5), 0.75);
    vec3 color = studio_light(v_position, facing, paint, 0.38);
    if (COLOURING == NORMAL)
        color = linear_light(0.5 + 0.5 * normal);
    if (WIREFRAME)
        color = mix(color, WIRE, 0.85 * wire_cover());
    out_color = vec4(color, 1.0);
}
