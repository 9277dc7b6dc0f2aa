// Needles that stand on a surface, each a thin pyramid along a direction.
// vec3 needle_side(vec3 corner, vec3 along): which way a corner of the pyramid lies off its axis.
// vec3 needle_corner(vec3 corner, vec3 root, vec3 along, float size): where it is.
// Corners are given across, across and along: the foot's four at (±1, 0, 0) and (0, ±1, 0), the tip at (0, 0, 1).
#include "lib/tangents.glsl"

vec3 needle_side(vec3 corner, vec3 along) {
    vec3 first, second;
    tangents(along, first, second);
    return corner.x * first + corner.y * second;
}

vec3 needle_corner(vec3 corner, vec3 root, vec3 along, float size) {
    return root + size * (0.035 * needle_side(corner, along) + corner.z * along);
}
