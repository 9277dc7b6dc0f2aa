// The layer of sprites: rgb is the light that they add, a how much of what lies behind shows through.
// vec4 sprites_at(ivec2 pixel); vec3 behind(vec4 sprites, vec3 light).

uniform sampler2D u_sprites;

const float BRIGHTEST_HALF_FLOAT = 65504.0;     // where very many sprites overlap the sum can overflow

vec4 sprites_at(ivec2 pixel) {
    vec4 sprites = texelFetch(u_sprites, pixel, 0);
    return vec4(min(sprites.rgb, BRIGHTEST_HALF_FLOAT), sprites.a);
}

vec3 behind(vec4 sprites, vec3 light) {
    return light * sprites.a + sprites.rgb;
}
