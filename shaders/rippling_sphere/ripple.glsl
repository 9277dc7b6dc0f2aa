// The rippled sphere: where a vertex goes, and six answers to the question of its normal.
// vec3 rippled(vec3 p): the place of the point p of the unit sphere.
// vec3 ripple_normal(vec3 p, int way, float epsilon): its normal, of length one.
#include "lib/frame.glsl"
#include "lib/tangents.glsl"
#include "generated/displacement.glsl"

uniform int u_direction;          // 0 along x, 1 along the sphere's normal

const int ALONG_X = 0;

const int NONE = 0;               // the sphere's own normal, as if nothing had moved
const int NOTES = 1;              // add the derivative
const int GRADIENT = 2;           // subtract the derivative
const int EXACT = 3;              // the cofactors of the displacement's Jacobian
const int FORWARD = 4;            // differences of neighbours at p, p + epsilon
const int CENTRAL = 5;            // differences of neighbours at p - epsilon, p + epsilon

// How far the vertex moves. Where the formula has no value there is no ripple.
float ripple_height(vec3 p) {
    float height = displacement(p);
    return abs(height) <= 100.0 ? height : 0.0;
}

// How steeply that changes in x, y and z, by the formula's own derivatives.
vec3 ripple_slope(vec3 p) {
    vec3 slope = displacement_gradient(p);
    bool has_value = abs(displacement(p)) <= 100.0 && dot(slope, slope) < 1e12;
    return has_value ? slope : vec3(0.0);
}

vec3 rippled(vec3 p) {
    vec3 direction = u_direction == ALONG_X ? vec3(1.0, 0.0, 0.0) : p;
    return p + ripple_height(p) * direction;
}

// Moving p by d(p) turns an area's normal n into cof(I + grad d) n. With d = f along x, and with
// d = f along n, the cofactors work out to these two lines.
vec3 exact_normal(vec3 p) {
    vec3 slope = ripple_slope(p);
    if (u_direction == ALONG_X)
        return (1.0 + slope.x) * p - p.x * slope;
    float stretch = 1.0 + ripple_height(p);
    vec3 along_surface = slope - dot(slope, p) * p;
    return stretch * (stretch * p - along_surface);
}

vec3 forward_normal(vec3 p, float epsilon) {
    vec3 first, second;
    tangents(p, first, second);
    vec3 here = rippled(p);
    vec3 along_first = rippled(normalize(p + epsilon * first)) - here;
    vec3 along_second = rippled(normalize(p + epsilon * second)) - here;
    return cross(along_first, along_second) / (epsilon * epsilon);
}

vec3 central_normal(vec3 p, float epsilon) {
    vec3 first, second;
    tangents(p, first, second);
    vec3 along_first = rippled(normalize(p + epsilon * first)) - rippled(normalize(p - epsilon * first));
    vec3 along_second = rippled(normalize(p + epsilon * second)) - rippled(normalize(p - epsilon * second));
    return cross(along_first, along_second) / (epsilon * epsilon);
}

vec3 ripple_normal(vec3 p, int way, float epsilon) {
    vec3 normal = p;
    if (way == NOTES) normal = p + ripple_slope(p);
    if (way == GRADIENT) normal = p - ripple_slope(p);
    if (way == EXACT) normal = exact_normal(p);
    if (way == FORWARD) normal = forward_normal(p, epsilon);
    if (way == CENTRAL) normal = central_normal(p, epsilon);
    float size = length(normal);
    return size > 0.0 && size < 1e30 ? normal / size : p;    // no direction left: round-off ate it
}
