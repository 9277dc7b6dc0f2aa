#version 330 core
// From linear light to the screen: tone mapping, then sRGB encoding, then a dither against banding.
#include "lib/color.glsl"

uniform sampler2D u_linear;

out vec4 out_color;

// Keeps colours as they are up to 0.76, then rolls highlights off towards white
// (Khronos PBR Neutral tone mapper, 2024), so that colour maps keep their meaning.
vec3 tone_mapped(vec3 light) {
    const float start = 0.8 - 0.04;
    const float desaturation = 0.15;
    float lowest = min(light.r, min(light.g, light.b));
    float offset = lowest < 0.08 ? lowest - 6.25 * lowest * lowest : 0.04;
    light -= offset;
    float peak = max(light.r, max(light.g, light.b));
    if (peak < start)
        return light;
    float room = 1.0 - start;
    float new_peak = 1.0 - room * room / (peak + room - start);
    light *= new_peak / peak;
    float keep = 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(vec3(new_peak), light, keep);
}

// A repeating 4x4 pattern of thresholds (Bayer 1973), from -0.5 to 0.5.
float ordered_threshold(ivec2 pixel) {
    const int bayer[16] = int[](0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5);
    return (float(bayer[(pixel.y & 3) * 4 + (pixel.x & 3)]) + 0.5) / 16.0 - 0.5;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 encoded = srgb_encoded(tone_mapped(max(texelFetch(u_linear, pixel, 0).rgb, 0.0)));
    out_color = vec4(encoded + ordered_threshold(pixel) / 255.0, 1.0);
}
