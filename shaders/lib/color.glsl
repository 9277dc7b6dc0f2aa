// Colours: sRGB encoding, a perceptual colour map, and categorical colours that everybody can tell apart.
// vec3 srgb_encoded(vec3 linear); vec3 linear_light(vec3 encoded);
// vec3 viridis(float t): linear light for t in 0 to 1; vec3 okabe_ito(int index).

vec3 srgb_encoded(vec3 linear) {
    vec3 low = 12.92 * linear;
    vec3 high = 1.055 * pow(max(linear, 0.0031308), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

vec3 linear_light(vec3 encoded) {
    vec3 low = encoded / 12.92;
    vec3 high = pow((encoded + 0.055) / 1.055, vec3(2.4));
    return mix(high, low, lessThanEqual(encoded, vec3(0.04045)));
}

// Nine colours of viridis (van der Walt and Smith 2015), evenly spaced and blended in between.
vec3 viridis(float t) {
    const vec3 stops[9] = vec3[](
        vec3(0.267, 0.005, 0.329), vec3(0.279, 0.175, 0.483), vec3(0.231, 0.318, 0.545),
        vec3(0.173, 0.449, 0.558), vec3(0.128, 0.567, 0.551), vec3(0.158, 0.684, 0.502),
        vec3(0.369, 0.789, 0.383), vec3(0.678, 0.864, 0.190), vec3(0.993, 0.906, 0.144));
    float place = clamp(t, 0.0, 1.0) * 8.0;
    int stop = min(int(place), 7);
    return linear_light(mix(stops[stop], stops[stop + 1], place - float(stop)));
}

// Okabe and Ito 2008: black, orange, sky blue, green, yellow, blue, vermilion, purple.
vec3 okabe_ito(int index) {
    const vec3 colors[8] = vec3[](
        vec3(0.000, 0.000, 0.000), vec3(0.902, 0.624, 0.000), vec3(0.337, 0.706, 0.914), vec3(0.000, 0.620, 0.451),
        vec3(0.941, 0.894, 0.259), vec3(0.000, 0.447, 0.698), vec3(0.835, 0.369, 0.000), vec3(0.800, 0.475, 0.655));
    return linear_light(colors[index & 7]);
}
