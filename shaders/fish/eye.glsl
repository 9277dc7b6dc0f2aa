// A fish's eye: a black pupil, a ring of gold, an iris of fibres that run outwards, and a dark rim.
// Finish eye_finish(vec2 place, vec3 iris): for a place on its disc, 0 in the middle and 1 at the rim.
// float catchlight(vec3 normal, vec3 to_eye): the lamp of whoever takes the picture, mirrored in the cornea.

Finish eye_finish(vec2 place, vec3 iris) {
    float out_of_middle = length(place);
    vec2 way = place / max(out_of_middle, 1e-4);
    // The pupil of a fish is a little pointed towards the nose.
    float pupil = 0.47 + 0.05 * smoothstep(0.6, 1.0, way.x);
    float fibres = 0.35 * sin(19.0 * way.x + 13.0 * way.y * way.x) + 0.25 * sin(37.0 * way.y + 9.0 * out_of_middle);
    float ring = 1.0 - smoothstep(0.02, 0.09, abs(out_of_middle - pupil - 0.05));
    vec3 color = iris * (0.62 + 0.55 * fibres);
    color = mix(color, vec3(0.95, 0.66, 0.22), 0.8 * ring);
    color *= 1.0 - 0.85 * smoothstep(0.76, 0.97, out_of_middle);
    float inside = 1.0 - smoothstep(pupil - 0.035, pupil + 0.02, out_of_middle);
    color = mix(color, vec3(0.004, 0.005, 0.008), inside);
    return Finish(color, vec3(3.0), 0.22, 0.0);
}

float catchlight(vec3 normal, vec3 to_eye) {
    vec3 halfway = normalize(to_eye + vec3(-0.12, 0.30, 0.0));
    return smoothstep(0.984, 0.993, dot(normal, halfway));
}
