#version 330 core
// A pixel of a sprite: what light it adds, and how much it hides (premultiplied).
#include "generated/look.glsl"
#include "generated/sprite.glsl"
#include "particles/sprite_kinds.glsl"
#include "particles/lens.glsl"

in vec2 v_corner;
flat in vec2 v_middle;
flat in vec2 v_pixel;
flat in vec2 v_shares;
flat in vec4 v_tint;
flat in vec2 v_axis;
flat in vec2 v_extent;
flat in vec2 v_soft;
flat in vec2 v_own;
flat in vec3 v_key;
flat in vec3 v_up;
flat in vec3 v_mean;

uniform sampler2D u_scene_depth;
uniform float u_lighting;

out vec4 out_color;

#include "particles/sprite_shapes.glsl"

const vec3 OUTLINE = vec3(0.09, 0.46, 0.81);

float scene_depth() {
    return texelFetch(u_scene_depth, ivec2(gl_FragCoord.xy), 0).r;
}

// The part of the pixel that the polygon's edge covers.
float outline() {
    vec2 inside = (1.0 - abs(v_corner)) * v_extent;
    return 0.85 * clamp(1.5 - min(inside.x, inside.y), 0.0, 1.0);
}

void main() {
    if (COUNTED) {
        if (gl_FragCoord.z > scene_depth())
            discard;
        out_color = vec4(1.0);
        return;
    }
    vec2 away = gl_FragCoord.xy - v_middle;
    vec2 place = BILLBOARD != FACES_CAMERA ? v_corner :
                 v_pixel.x * (USES_TURN ? vec2(dot(away, v_axis), dot(away, vec2(-v_axis.y, v_axis.x))) : away);
    vec4 shape = shape_at(place);
    shape.a *= v_shares.x;
    if (BILLBOARD == FACES_CAMERA) {        // tents on neighbouring pixels sum to 1, wherever the middle is
        vec2 tent = max(1.0 - abs(away), 0.0);
        float blot = v_shares.y * tent.x * tent.y;
        shape = vec4(shape.rgb * shape.a + mean_shade() * blot, shape.a + blot);
    } else {
        shape.rgb *= shape.a;
    }
    if (HIDES)
        shape *= min(1.0, 1.0 / max(v_tint.a * shape.a, 1e-6));
    float opacity = v_tint.a;
    if (FADES)
        opacity *= clamp((distance_at(scene_depth()) - v_soft.x) * v_soft.y, 0.0, 1.0);
    out_color = opacity * vec4(v_tint.rgb * shape.rgb, HIDES ? shape.a : 0.0);
    if (OUTLINED) {
        float line = outline();
        out_color = vec4(line * OUTLINE, line) + (1.0 - line) * out_color;
    }
}
