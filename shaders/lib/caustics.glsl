// The light that waves on the water gather into moving lines, from a tile that repeats without a seam.
// float caustic_light(vec3 position): how many times as bright as below still water, 1 on average.
// float soft_caustic_light(vec3 position): the same four times as wide and blurred, for shafts of light.
#include "lib/frame.glsl"

uniform sampler2D u_light_net;      // one tile, seen from above
uniform sampler2D u_soft_light_net; // the same, before the light has come together
uniform float u_caustics;  // 0 an even light, 1 as the waves make it

// Where the light that reaches a position came through the level of the scene's centre, in tiles.
vec2 caustic_place(vec3 position) {
    vec2 drift = u_frame.key_direction.xz / u_frame.key_direction.y;
    float tile = max(1.15, 0.42 * u_frame.radius);      // metres; wider where all is seen from farther away
    return (position.xz - (position.y - u_frame.center.y) * drift) / tile;
}

// Two looks at the tile, turned against each other by angles whose tangent is 3/4: the eye finds no repetition.
float caustic_light(vec3 position) {
    vec2 place = caustic_place(position);
    vec2 turned = 0.61 * vec2(0.8 * place.x - 0.6 * place.y, 0.6 * place.x + 0.8 * place.y);
    float gathered = 0.62 * texture(u_light_net, place).r + 0.38 * texture(u_light_net, turned + 0.37).r;
    gathered = 1.12 * gathered / (1.0 + 0.12 * gathered);       // the sun is no point: no line is ever too bright
    return max(mix(1.0, gathered, u_caustics), 0.0);
}

float soft_caustic_light(vec3 position) {
    return max(mix(1.0, texture(u_soft_light_net, 0.27 * caustic_place(position)).r, u_caustics), 0.0);
}
