// What particles bounce off: a ground plane and one obstacle.
// float collider_distance(vec3 p): metres to the nearest surface, negative inside what is solid. It never changes
// by more than the way gone, so that one who goes that far meets no surface (Hart, "Sphere Tracing", 1996).
// float collider_clearance(vec3 p): how far off a surface is surely off it.
// vec3 collider_normal(vec3 p): of length one, towards where particles may be; finite everywhere.
// A hollow obstacle is a vessel: what is solid is its outside.
#include "generated/collider.glsl"

const int COLLISION_BOUNCE = 0;
const int COLLISION_STICK = 1;
const int COLLISION_DIE = 2;

const int OBSTACLE_SPHERE = 1;
const int OBSTACLE_BOX = 2;
const int OBSTACLE_TORUS = 3;
const int OBSTACLE_FIELD = 4;

const float NOTHING_NEAR = 1e9;
const vec3 UP = vec3(0.0, 1.0, 0.0);

uniform vec4 u_collider_plane;          // the ground: its normal, and that times a place on it
uniform vec3 u_collider_center;         // the obstacle, in the world
uniform mat3 u_collider_turn;           // from the world's directions to the obstacle's own
uniform vec3 u_collider_size;           // radius; half extents; radii of ring and tube; or the field's scale
uniform sampler3D u_distance_field;     // in the obstacle's own units
uniform vec3 u_field_origin;            // where its first sample is
uniform vec3 u_field_extent;            // from there to the last
uniform float u_field_cell;

vec3 direction_of(vec3 v, vec3 otherwise) {
    float size = length(v);
    return size > 1e-20 && size < 1e20 ? v / size : otherwise;
}

vec3 sign_of(vec3 v) {
    return vec3(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0, v.z < 0.0 ? -1.0 : 1.0);
}

float box_distance(vec3 p, vec3 half_extents) {
    vec3 beyond = abs(p) - half_extents;
    return length(max(beyond, 0.0)) + min(max(beyond.x, max(beyond.y, beyond.z)), 0.0);
}

vec3 box_normal(vec3 p, vec3 half_extents) {
    vec3 beyond = abs(p) - half_extents;
    float deepest = max(beyond.x, max(beyond.y, beyond.z));
    vec3 nearest_face = beyond.x == deepest ? vec3(1.0, 0.0, 0.0)
                      : beyond.y == deepest ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    return sign_of(p) * (deepest > 0.0 ? direction_of(max(beyond, 0.0), nearest_face) : nearest_face);
}

// From the nearest place on the circle in the middle of the tube, across and up.
vec2 from_ring(vec3 p, float ring_radius) {
    return vec2(length(p.xz) - ring_radius, p.y);
}

vec3 torus_normal(vec3 p, float ring_radius) {
    vec3 away = direction_of(vec3(p.x, 0.0, p.z), vec3(1.0, 0.0, 0.0));
    vec2 q = from_ring(p, ring_radius);
    return direction_of(q.x * away + q.y * UP, UP);
}

// Beyond the grid the surface is at least as far as if it lay at a right angle to the way to the grid.
float field_distance(vec3 p) {
    vec3 place = p - u_field_origin;
    vec3 inside = clamp(place, vec3(0.0), u_field_extent);
    vec3 samples = vec3(textureSize(u_distance_field, 0));
    vec3 texel = (inside / u_field_extent * (samples - 1.0) + 0.5) / samples;
    float at_border = textureLod(u_distance_field, texel, 0.0).r;
    float away = length(place - inside);
    return away > 0.0 ? length(vec2(away, at_border)) : at_border;
}

// Differences between the corners of a tetrahedron, half a cell from its middle.
vec3 field_normal(vec3 p) {
    vec2 corner = vec2(1.0, -1.0);
    float h = 0.29 * u_field_cell;
    vec3 slope = corner.xyy * field_distance(p + h * corner.xyy) + corner.yyx * field_distance(p + h * corner.yyx)
               + corner.yxy * field_distance(p + h * corner.yxy) + corner.xxx * field_distance(p + h * corner.xxx);
    return direction_of(slope, UP);
}

// From the obstacle's middle in its own directions; a sphere has none.
vec3 in_obstacle(vec3 p) {
    vec3 away = p - u_collider_center;
    return OBSTACLE == OBSTACLE_SPHERE ? away : u_collider_turn * away;
}

float obstacle_distance(vec3 p) {
    vec3 local = in_obstacle(p);
    float found = NOTHING_NEAR;
    if (OBSTACLE == OBSTACLE_SPHERE)
        found = length(local) - u_collider_size.x;
    if (OBSTACLE == OBSTACLE_BOX)
        found = box_distance(local, u_collider_size);
    if (OBSTACLE == OBSTACLE_TORUS)
        found = length(from_ring(local, u_collider_size.x)) - u_collider_size.y;
    if (OBSTACLE == OBSTACLE_FIELD)
        found = field_distance(local / u_collider_size.x) * u_collider_size.x;
    return HOLLOW ? -found : found;
}

vec3 obstacle_normal(vec3 p) {
    vec3 local = in_obstacle(p);
    vec3 found = UP;
    if (OBSTACLE == OBSTACLE_SPHERE)
        found = direction_of(local, UP);
    if (OBSTACLE == OBSTACLE_BOX)
        found = box_normal(local, u_collider_size);
    if (OBSTACLE == OBSTACLE_TORUS)
        found = torus_normal(local, u_collider_size.x);
    if (OBSTACLE == OBSTACLE_FIELD)
        found = field_normal(local / u_collider_size.x);
    if (OBSTACLE != OBSTACLE_SPHERE)
        found = found * u_collider_turn;    // its transpose turns back
    return HOLLOW ? -found : found;
}

float ground_distance(vec3 p) {
    return dot(u_collider_plane.xyz, p) - u_collider_plane.w;
}

float collider_distance(vec3 p) {
    float nearest = NOTHING_NEAR;
    if (HAS_GROUND)
        nearest = ground_distance(p);
    if (OBSTACLE != 0)
        nearest = min(nearest, obstacle_distance(p));
    return nearest;
}

vec3 collider_normal(vec3 p) {
    if (OBSTACLE == 0)
        return HAS_GROUND ? u_collider_plane.xyz : UP;
    if (HAS_GROUND)
        if (ground_distance(p) <= obstacle_distance(p))
            return u_collider_plane.xyz;
    return obstacle_normal(p);
}

// So far off a surface one is surely off it, with the rounding there is at p.
float collider_clearance(vec3 p) {
    return 1e-6 + 4e-7 * (abs(p.x) + abs(p.y) + abs(p.z));
}
