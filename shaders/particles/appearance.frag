#version 330 core
// What each particle looks like from here, one a pixel: where its sprite stands in the picture and how large it is,
// its colour, and a key by which to draw the farthest first. Who cannot be seen gets the last key; two bits above
// the key's sixteen tell what is too large for a point, and what fades pixel by pixel.
#include "generated/look.glsl"
#include "particles/sprite_kinds.glsl"
#include "particles/lens.glsl"
#include "particles/random.glsl"
#include "particles/tint.glsl"

uniform sampler2D u_motion, u_velocity, u_nature, u_origin, u_launch;
uniform float u_stretch;
uniform float u_softness;
uniform float u_opacity;
uniform vec2 u_spin;            // degrees a second
uniform float u_largest_point;  // in pixels
uniform sampler2D u_scene_depth;

layout(location = 0) out vec4 out_place;    // middle in pixels, window depth, half the width in pixels
layout(location = 1) out vec4 out_tint;     // its light where it is opaque, and its opacity
layout(location = 2) out vec4 out_turn;     // key light that reaches it, a random number, its turn's cosine and sine
                                            // or, where it tumbles, how much farther its right and upper edges are
layout(location = 3) out uint out_key;
layout(location = 4) out vec4 out_axes;     // from the middle to the polygon's right edge, and to its upper one

const uint UNSEEN = 65535u;
const float FULL_TURN = 6.283185307179586;
const float LARGEST = 16384.0;              // half of a sprite, in pixels

struct Particle {
    vec3 place, velocity, view;             // in the world, and its place before the camera
    uint identity;
    float over, age;                        // how much of its life is over, and seconds
    float diameter, opacity;                // as they now are
    bool stuck;
};

struct Polygon {
    vec2 middle;                            // in pixels
    vec4 axes;                              // to the middle of its right and its upper edge, in pixels
    vec2 depths;                            // how much farther those are, in metres
    vec3 normal;                            // in the world
};

vec2 pixel_of(vec3 view) {
    vec4 clip = u_frame.projection * vec4(view, 1.0);
    return (0.5 * clip.xy / clip.w + 0.5) * u_frame.resolution;
}

// How far the picture has turned since birth, in radians. What is stuck turns no more.
float turned_by(Particle one) {
    bool upright = SPRITE == STAR || SPRITE == PICTURE && BILLBOARD != TUMBLES;
    float start = upright ? 0.0 : random_of(one.identity, 63u);
    float rate = SPINS && !one.stuck ? mix(u_spin.x, u_spin.y, random_of(one.identity, 60u)) / 360.0 : 0.0;
    return FULL_TURN * fract(start + fract(rate * one.age));
}

Polygon facing_camera(Particle one, float scale) {
    float angle = TURNS ? turned_by(one) : 0.0;
    vec2 turn = vec2(cos(angle), sin(angle));
    vec4 axes = 0.5 * one.diameter * scale * vec4(turn, -turn.y, turn.x);
    return Polygon(pixel_of(one.view), axes, turn, u_frame.key_direction);
}

// From the last moment's place to the present one, and beyond either by the radius.
Polygon stretched(Particle one, float scale) {
    vec3 back = -min(u_stretch, one.age) * (mat3(u_frame.view) * one.velocity);
    float room = -one.view.z - nearest();       // no farther back than to the eye
    back *= back.z > room ? max(room, 0.0) / back.z : 1.0;
    vec2 head = pixel_of(one.view), tail = pixel_of(one.view + back);
    vec2 way = 0.5 * (head - tail);
    float radius = 0.5 * one.diameter * scale, gone = length(way);
    vec2 along = gone > 1e-4 ? way / gone : vec2(1.0, 0.0);
    vec4 axes = vec4(along * min(gone + radius, LARGEST), radius * vec2(-along.y, along.x));
    return Polygon(0.5 * (head + tail), axes, vec2(0.0), u_frame.key_direction);
}

vec3 any_direction(uint identity, uint channel) {
    float y = 2.0 * random_of(identity, channel) - 1.0, angle = FULL_TURN * random_of(identity, channel + 1u);
    return vec3(0.0, y, 0.0) + sqrt(max(0.0, 1.0 - y * y)) * vec3(sin(angle), 0.0, cos(angle));
}

vec3 rotated(vec3 v, vec3 axis, float angle) {
    return mix(axis * dot(axis, v), v, cos(angle)) + sin(angle) * cross(axis, v);
}

// Two unit vectors in the polygon, and its normal, in the world; what is stuck lies about flat.
mat3 tumbled(Particle one) {
    vec3 axis = normalize(any_direction(one.identity, 64u) + 1e-6);
    vec3 normal = any_direction(one.identity, 66u);
    if (one.stuck) {
        axis = vec3(0.0, 1.0, 0.0);
        normal = axis + 0.12 * normal;
    }
    normal = normalize(normal + 1e-6);
    vec3 first = normalize(cross(normal, abs(normal.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0)));
    float angle = turned_by(one);
    first = rotated(first, axis, angle);
    normal = rotated(normal, axis, angle);
    return mat3(first, cross(normal, first), normal);
}

// How far a small step, as the camera sees it, leads in the picture.
vec2 in_picture(vec3 moved, vec3 view, float scale) {
    return scale * (moved.xy - moved.z * view.xy / view.z);
}

Polygon tumbling(Particle one, float scale) {
    mat3 frame = tumbled(one);
    float radius = 0.5 * one.diameter;
    vec3 right = radius * (mat3(u_frame.view) * frame[0]), up = radius * (mat3(u_frame.view) * frame[1]);
    vec4 axes = vec4(in_picture(right, one.view, scale), in_picture(up, one.view, scale));
    return Polygon(pixel_of(one.view), axes, -vec2(right.z, up.z), frame[2]);
}

uint key_of(float away, float radius) {
    float nearness = 1.0 - log(away / nearest()) / log(farthest() / nearest());
    uint too_large = 2.0 * radius > u_largest_point ? 0x10000u : 0u, fades = radius >= FADES_AS_ONE ? 0x20000u : 0u;
    return uint(65534.0 * clamp(nearness, 0.0, 1.0)) | too_large | fades;
}

// How much is left of a small sprite near to what is solid. Where that is far in front the depth test will tell.
float before_solid(vec2 middle, float away, float diameter) {
    ivec2 pixel = ivec2(clamp(middle, vec2(0.0), u_frame.resolution - 1.0));
    float gap = distance_at(texelFetch(u_scene_depth, pixel, 0).r) - away, reach = min(u_softness, diameter);
    return gap < -reach ? 1.0 : clamp(gap / max(reach, 1e-6), 0.0, 1.0);
}

Particle particle_at(ivec2 slot, out float left_to_live) {
    vec4 motion = texelFetch(u_motion, slot, 0), velocity = texelFetch(u_velocity, slot, 0);
    vec4 nature = texelFetch(u_nature, slot, 0);
    left_to_live = motion.w;
    Particle one;
    one.stuck = velocity.w < 0.0;
    one.identity = uint(abs(velocity.w));
    one.velocity = velocity.xyz;
    one.over = clamp(1.0 - motion.w / max(nature.x, 1e-6), 0.0, 1.0);
    one.age = one.over * nature.x;
    vec2 size_and_opacity = over_life(one.over, 0).xy;
    one.diameter = nature.y * size_and_opacity.x;
    one.opacity = COLOURING == BY_LOOK ? u_opacity * size_and_opacity.y : 1.0;  // what tells something is opaque
    one.place = motion.xyz;
    if (BILLBOARD == TUMBLES && one.stuck)      // on what it lies on, not in it
        one.place.y += 0.1 * one.diameter;
    one.view = (u_frame.view * vec4(one.place, 1.0)).xyz;
    return one;
}

Qualities qualities_of(Particle one, ivec2 slot) {
    vec4 nature = texelFetch(u_nature, slot, 0);
    float family = texelFetch(u_launch, slot, 0).w;
    return Qualities(one.identity, int(family), fract(family), one.over, length(one.velocity), nature.z, nature.y,
                     one.diameter);
}

bool is_outside(Polygon polygon) {
    vec2 reach = abs(polygon.axes.xy) + abs(polygon.axes.zw) + 2.0;
    return any(lessThan(polygon.middle + reach, vec2(0.0)))
        || any(greaterThan(polygon.middle - reach, u_frame.resolution));
}

void main() {
    ivec2 slot = ivec2(gl_FragCoord.xy);
    float left_to_live;
    Particle one = particle_at(slot, left_to_live);
    float away = -one.view.z;
    bool seen = left_to_live > 0.0 && one.diameter > 0.0 && away > 1.0001 * nearest() && away < farthest();
    if (!seen)
        one.view = vec3(0.0, 0.0, -1.0);        // where numbers stay finite
    away = -one.view.z;

    float scale = min(pixels_per_slope() / away, LARGEST / max(0.5 * one.diameter, 1e-6));
    float radius = 0.5 * one.diameter * scale;
    Polygon polygon = BILLBOARD == FOLLOWS_VELOCITY ? stretched(one, scale) :
                      BILLBOARD == TUMBLES ? tumbling(one, scale) : facing_camera(one, scale);
    float before_eye = away - nearest() - 0.5 * one.diameter;   // what the eye passes through fades away before
    one.opacity *= clamp(before_eye / (u_softness + 0.5 * one.diameter + 1e-6), 0.0, 1.0);
    if (SOFT && radius < FADES_AS_ONE)
        one.opacity *= before_solid(polygon.middle, away, one.diameter);
    float reaching;
    out_tint = tint(one.place, polygon.normal, qualities_of(one, slot), one.opacity, reaching);
    out_place = vec4(polygon.middle, depth_at(away), radius);
    out_axes = polygon.axes;
    out_turn = vec4(reaching, random_of(one.identity, 70u), polygon.depths);
    bool drawn = seen && !is_outside(polygon) && out_tint.a > 0.0;
    out_key = drawn ? key_of(away, radius) : UNSEEN;
}
