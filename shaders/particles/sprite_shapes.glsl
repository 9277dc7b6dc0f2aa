// What is drawn on a sprite.
// vec4 shape_at(vec2 place): how bright, by colour, and how opaque, at a place in the circle of radius 1.
// vec3 mean_shade(): how bright it is as a whole, for one that is too small to show more.
#include "particles/sprite_light.glsl"

uniform sampler2D u_picture;

const float TWO_PI = 6.283185307179586;

// A pixel's width where it is widest.
float pixel() { return max(v_pixel.x, v_pixel.y); }

float squared(float x) { return x * x; }

// Nothing may lie beyond, where a triangle and a square would show different parts of it.
float within_circle(vec2 place) { return step(dot(place, place), 1.0); }

vec4 spot(vec2 place) {
    return vec4(vec3(1.0), squared(max(1.0 - dot(place, place), 0.0)));
}

vec4 ball(vec2 place) {
    float radius = length(place);
    vec3 normal = vec3(place, sqrt(max(1.0 - radius * radius, 0.0)));
    return vec4(shaded(normal), clamp((1.0 - radius) / pixel(), 0.0, 1.0));
}

// Which of the smaller copies has about one texel for each pixel, the sprite being `texels` wide.
float copy_for(float texels) {
    return max(log2(0.5 * texels * pixel()), 0.0);
}

// Billows of noise on a hemisphere; the rim is eaten away where they are low.
vec4 puff(vec2 place) {
    float rim = max(1.0 - dot(place, place), 0.0);
    vec2 at = place * 0.20 + vec2(v_own.y, fract(37.0 * v_own.y));
    vec4 billow = textureLod(u_picture, at, copy_for(0.40 * 256.0));
    float height = 0.6 * billow.w + 0.4 * billow.x;
    float density = rim - 1.15 * (1.0 - height);
    vec3 normal = normalize(vec3(place - 0.5 * rim * billow.yz, 0.45 + sqrt(rim)));
    float hollows = mix(0.62, 1.12, smoothstep(0.25, 0.95, height));
    return vec4(shaded(normal) * hollows, smoothstep(-0.15, 0.85, density) * smoothstep(0.0, 0.4, rim));
}

float from_line(vec2 place, vec2 start, vec2 end) {
    vec2 way = end - start, from = place - start;
    return length(from - way * clamp(dot(from, way) / dot(way, way), 0.0, 1.0));
}

// A dendrite: an arm with branches at 60 degrees, folded six times; a plate in the middle.
vec4 flake(vec2 place) {
    vec2 p = abs(place);
    float beyond = max(dot(p, vec2(-0.5, 0.8660254)), 0.0);
    p -= 2.0 * beyond * vec2(-0.5, 0.8660254);
    p.y = abs(p.y);
    float first = v_own.y, second = fract(37.0 * first), third = fract(61.0 * first);
    float plate = dot(p, vec2(0.8660254, 0.5)) - mix(0.08, 0.34, first * first);
    float width = max(0.030, 0.55 * pixel()), edge = max(pixel(), 0.02);
    float line = from_line(p, vec2(0.0), vec2(min(0.95, 1.0 - width), 0.0));
    vec2 slant = vec2(0.5, 0.8660254);
    for (int branch = 0; branch < 3; ++branch) {
        float at = mix(0.30, 0.40, second) + 0.20 * float(branch);
        float reach = (0.98 - at) * mix(0.25, 0.72, fract(third + 0.37 * float(branch)));
        line = min(line, from_line(p, vec2(at, 0.0), vec2(at, 0.0) + reach * slant));
    }
    float arms = clamp(0.5 + (width - line) / edge, 0.0, 1.0) * min(1.0, 0.045 / width + 0.35);
    float inner = clamp(0.5 - plate / edge, 0.0, 1.0) * (0.45 + 0.35 * smoothstep(-0.10, 0.0, plate));
    return vec4(vec3(1.0), max(arms, inner) * within_circle(place));
}

// A blade around a bent midrib, with side veins; broad or slim.
vec4 leaf(vec2 place) {
    float along = place.x, bend = 0.22 * (v_own.y - 0.5) * (1.0 - along * along);
    float across = place.y - bend, side = abs(across);
    vec2 thin = max(v_pixel, 0.004);
    float open = max(1.0 - squared(along * 1.06 - 0.06), 0.0);
    float half_width = mix(0.36, 0.56, fract(37.0 * v_own.y)) * open * (1.0 - 0.32 * along);
    float seen = smoothstep(0.12, 0.03, thin.x), seen_across = smoothstep(0.25, 0.08, thin.y);
    half_width *= 1.0 - 0.13 * seen * abs(fract(9.0 * along + 0.25) - 0.5);
    float blade = clamp(0.5 + (half_width - side) / (1.3 * thin.y), 0.0, 1.0)
                * clamp(0.5 + (along + 0.86) / thin.x, 0.0, 1.0);
    float stem = clamp(0.5 + (0.022 - side) / thin.y, 0.0, 1.0)
               * clamp(0.5 + (along + 0.98) / thin.x, 0.0, 1.0) * step(along, 0.0);
    float midrib = seen_across * (1.0 - smoothstep(0.012, 0.03 + thin.y, side));
    float vein = seen * seen_across * smoothstep(0.34, 0.5, abs(fract(5.5 * (along - 0.75 * side)) - 0.5));
    float outer = side / max(half_width, 1e-3);
    float shade = 0.80 + 0.25 * midrib + 0.22 * vein - 0.18 * smoothstep(0.4, 1.0, outer);
    vec3 ageing = mix(vec3(1.0), vec3(1.12, 0.80, 0.55), 0.5 * smoothstep(0.5, 1.0, outer));
    return vec4(shade * ageing, max(blade, stem) * within_circle(place));
}

// A bright core and the rays of a lens, four long and four short.
vec4 star(vec2 place) {
    float window = squared(max(1.0 - dot(place, place), 0.0));
    vec2 slanted = vec2(place.x + place.y, place.x - place.y) * 0.70710678;
    vec2 thin = vec2(max(0.0009, 0.3 * pixel() * pixel()));
    vec2 rays = thin / (thin + place.yx * place.yx) * squared(window);
    vec2 short_rays = thin / (thin + slanted * slanted) * squared(squared(window));
    float halo = 1.0 / (1.0 + 90.0 * dot(place, place));
    float core = window * (halo * halo * 1.6 + 0.12 * halo);
    float light = core + 0.55 * (rays.x + rays.y) + 0.16 * (short_rays.x + short_rays.y);
    return vec4(vec3(1.0), min(light, 1.5));
}

// A thin skin is seen through more of itself towards its rim; it mirrors a window, and its colours interfere.
vec4 ring(vec2 place) {
    float around = dot(place, place), radius = sqrt(around);
    float skin = 0.05 + 0.75 * squared(squared(around)) * around;
    vec2 upright = place.x * v_axis + place.y * vec2(-v_axis.y, v_axis.x);      // the window does not turn with it
    vec2 window = upright - vec2(-0.36, 0.44), lower = upright - vec2(0.42, -0.50);
    float mirrored = squared(max(1.0 - 14.0 * dot(window, window), 0.0));
    mirrored += 0.35 * squared(max(1.0 - 22.0 * dot(lower, lower), 0.0));
    vec3 film = 1.0 + 0.35 * cos(TWO_PI * (1.3 * around + v_own.y + 0.15 * place.y + vec3(0.0, 0.33, 0.67)));
    float opacity = clamp(skin + mirrored, 0.0, 1.0);
    vec3 shade = mix(film, vec3(1.3), mirrored / max(skin + mirrored, 1e-3));
    return vec4(shade, opacity * clamp((1.0 - radius) / pixel(), 0.0, 1.0));
}

vec4 picture(vec2 place) {
    vec4 texel = textureLod(u_picture, 0.5 * place + 0.5, copy_for(float(textureSize(u_picture, 0).x)));
    return vec4(texel.rgb / max(texel.a, 1e-4), texel.a);
}

vec4 shape_at(vec2 place) {
    if (SPRITE == BALL) return ball(place);
    if (SPRITE == PUFF) return puff(place);
    if (SPRITE == FLAKE) return flake(place);
    if (SPRITE == LEAF) return leaf(place);
    if (SPRITE == STAR) return star(place);
    if (SPRITE == RING) return ring(place);
    if (SPRITE == PICTURE) return picture(place);
    return spot(place);
}

vec3 mean_shade() {
    if (SPRITE == PICTURE) {
        vec4 mean = textureLod(u_picture, vec2(0.5), 20.0);
        return 2.0 * mean.rgb;      // a square of which half is covered is what sprite.vert reckons with
    }
    return SHADED ? v_mean : vec3(1.0);
}
