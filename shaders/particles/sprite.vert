#version 330 core
// A sprite from the textures that appearance.frag has filled: as a point, or as a polygon with gl_VertexID for its
// corner. All come out alike. What is too small to be drawn as it is becomes a blot of two by two pixels.
#include "generated/look.glsl"
#include "generated/sprite.glsl"
#include "particles/sprite_kinds.glsl"
#include "particles/lens.glsl"

in uint in_slot;

uniform sampler2D u_place, u_tint, u_axes, u_turn;
uniform float u_softness;
uniform float u_lighting;

out vec2 v_corner;                  // of a polygon, -1 to 1
flat out vec2 v_middle;             // in pixels
flat out vec2 v_pixel;              // a pixel's width along either axis, half a side being 1
flat out vec2 v_shares;             // of the sprite as such, and of its blot
flat out vec4 v_tint;
flat out vec2 v_axis;               // unit vector to the right edge
flat out vec2 v_extent;             // of a polygon's half sides, in pixels
flat out vec2 v_soft;               // its distance, and one over the length in which it fades
flat out vec2 v_own;                // the key light that reaches it, and a random number
flat out vec3 v_key;                // where the key light is, as the camera sees it
flat out vec3 v_up;
flat out vec3 v_mean;               // how bright it is as a whole

#include "particles/sprite_light.glsl"

const float SMALL = 2.0, LARGE = 3.4;       // pixels wide: up to here as a blot alone, from there as it is

vec2 around_square() {
    return vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, gl_VertexID < 2 ? -1.0 : 1.0);
}

// What fills no more than the circle needs but one triangle.
vec2 around_circle() {
    return gl_VertexID == 2 ? vec2(0.0, 2.0) : vec2(gl_VertexID == 0 ? -1.7320509 : 1.7320509, -1.0);
}

vec2 at_least_a_pixel(vec2 axis, vec2 otherwise, inout float share) {
    float size = length(axis);
    share *= min(size, 1.0);
    return size >= 1.0 ? axis : size > 1e-6 ? axis / size : otherwise;
}

// The polygon's axes; what is too thin for the pixels is drawn wider, and fainter.
vec4 polygon_axes(ivec2 slot, float drawn) {
    if (BILLBOARD == FACES_CAMERA)
        return drawn * vec4(v_axis, -v_axis.y, v_axis.x);
    vec4 axes = texelFetch(u_axes, slot, 0);
    float share = 1.0;
    axes.xy = at_least_a_pixel(axes.xy, vec2(1.0, 0.0), share);
    axes.zw = at_least_a_pixel(axes.zw, vec2(0.0, 1.0), share);
    v_tint.a *= share;
    v_extent = vec2(length(axes.xy), length(axes.zw));
    v_axis = axes.xy / v_extent.x;
    v_pixel = 1.0 / v_extent;
    return axes;
}

// While it is small its light depends most on where its middle lies: then the blot has the greater share.
void share_out(float radius) {
    float as_such = BILLBOARD == FACES_CAMERA ? clamp((2.0 * radius - SMALL) / (LARGE - SMALL), 0.0, 1.0) : 1.0;
    as_such *= as_such;
    v_shares = vec2(as_such, (1.0 - as_such) * 4.0 * radius * radius * AREAS[SPRITE]);
}

void tell_fragments(float depth, float radius) {
    if (FADES) {
        float away = distance_at(depth);
        float reach = max(min(u_softness, 2.0 * radius * away / pixels_per_slope()), 1e-6);
        v_soft = radius < FADES_AS_ONE ? vec2(-1.0, 1e6) : vec2(away, 1.0 / reach);
    }
    if (SHADED) {
        v_key = mat3(u_frame.view) * u_frame.key_direction;
        v_up = u_frame.view[1].xyz;
        v_mean = shaded(vec3(0.0, 0.0, SPRITE == BALL ? 0.65 : 1.0));
    }
}

void main() {
    ivec2 slot = ivec2(int(in_slot) & WIDTH_MASK, int(in_slot) >> WIDTH_BITS);
    vec4 place = texelFetch(u_place, slot, 0);
    v_tint = texelFetch(u_tint, slot, 0);
    vec4 turn = USES_TURN ? texelFetch(u_turn, slot, 0) : vec4(1.0, 0.0, 1.0, 0.0);
    v_own = turn.xy;
    v_axis = BILLBOARD == TUMBLES ? vec2(1.0, 0.0) : turn.zw;

    float drawn = max(place.w, 1.0), depth = place.z;
    vec2 window = place.xy;
    v_middle = place.xy;
    v_pixel = vec2(1.0 / drawn);
    v_corner = vec2(0.0);
    v_extent = vec2(drawn);
    if (SHAPE == POINT) {           // GL leaves out points whose middle is beyond the border
        window = clamp(window, vec2(0.0), u_frame.resolution);
        gl_PointSize = 2.0 * drawn;
    } else {
        v_corner = SHAPE == TRIANGLE ? around_circle() : around_square();
        vec4 axes = polygon_axes(slot, drawn);
        window += v_corner.x * axes.xy + v_corner.y * axes.zw;
        if (BILLBOARD == TUMBLES)
            depth = depth_at(max(distance_at(depth) + dot(v_corner, turn.zw), 1.001 * nearest()));
    }
    share_out(place.w);
    tell_fragments(place.z, place.w);
    gl_Position = vec4(2.0 * window / u_frame.resolution - 1.0, clamp(2.0 * depth - 1.0, -1.0, 1.0), 1.0);
}
