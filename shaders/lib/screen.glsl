// From linear light to the screen.
// vec3 tone_mapped(vec3 light); vec3 for_screen(vec3 tone_mapped, ivec2 pixel): sRGB, dithered.
#include "lib/color.glsl"

// Keeps colours as they are up to 0.76, then rolls highlights off towards white
// (Khronos PBR Neutral tone mapper, 2024), so that colour maps keep their meaning.
vec3 tone_mapped(vec3 light) {
    const float start = 0.8 - 0.04;
    const float desaturation = 0.15;
    light = max(light, 0.0);
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

vec3 for_screen(vec3 color, ivec2 pixel) {
    return srgb_encoded(color) + ordered_threshold(pixel) / 255.0;
}
