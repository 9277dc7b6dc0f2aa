// The wall behind everything: a soft gradient, brighter around the middle of the picture.
// vec3 backdrop(vec2 pixel): linear light at a pixel's centre (gl_FragCoord.xy).
#include "lib/frame.glsl"

vec3 backdrop(vec2 pixel) {
    vec2 place = pixel / u_frame.resolution;
    vec3 wall = mix(u_frame.backdrop_low.rgb, u_frame.backdrop_high.rgb, smoothstep(0.0, 1.0, place.y));
    vec2 from_middle = (place - vec2(0.5, 0.45)) * vec2(u_frame.resolution.x / u_frame.resolution.y, 1.0);
    float vignette = exp(-0.55 * dot(from_middle, from_middle));
    return wall * mix(0.62, 1.08, vignette);
}
