// Light on thin round fibres.
// vec3 thin_cylinder(vec3 place, vec3 along): on white matter, with a gloss (Kajiya and Kay, "Rendering Fur with Three
// Dimensional Textures", 1989).
// vec3 hair_light(vec3 place, vec3 along, vec3 out_of, vec3 albedo, float shine, float sharpness, float open): from a
// hair, root to tip `along`, on a skin that it leaves `out_of`; `open` is how much of the sky it sees.
#include "lib/lighting.glsl"

vec3 thin_cylinder(vec3 place, vec3 along) {
    vec3 to_light = u_frame.key_direction, to_eye = normalize(u_frame.eye - place);
    float cos_light = dot(along, to_light), cos_eye = dot(along, to_eye);
    float sin_light = sqrt(max(0.0, 1.0 - cos_light * cos_light)), sin_eye = sqrt(max(0.0, 1.0 - cos_eye * cos_eye));
    float gloss = max(0.0, sin_light * sin_eye - cos_light * cos_eye);
    gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss; gloss *= gloss;
    float reaching = key_light_on_surface(place, to_light);
    vec3 around = mix(FLOOR_LIGHT, SKY_LIGHT, 0.5) + 0.4 * FILL_LIGHT;
    return around + reaching * KEY_LIGHT * (0.8 * sin_light / PI + 0.25 * gloss);
}

float lobe(float angle, float width) {
    return exp(-0.5 * angle * angle / (width * width));
}

// Two highlights: one mirrored off the scales of the hair's skin, white and shifted to the root, one through the hair
// and back, coloured and shifted to the tip; and light from behind that shines through. Angles and widths after
// Marschner et al., "Light Scattering from Human Hair Fibers", 2003, their sum after Scheuermann, 2004.
vec3 hair_light(vec3 place, vec3 along, vec3 out_of, vec3 albedo, float shine, float sharpness, float open) {
    vec3 to_light = u_frame.key_direction, to_eye = normalize(u_frame.eye - place);
    float sin_light = clamp(dot(along, to_light), -1.0, 1.0), sin_eye = clamp(dot(along, to_eye), -1.0, 1.0);
    float half_angle = 0.5 * (asin(sin_light) + asin(sin_eye));
    vec3 light_across = to_light - sin_light * along, eye_across = to_eye - sin_eye * along;
    float cos_around = dot(light_across, eye_across)
                     / max(sqrt(dot(light_across, light_across) * dot(eye_across, eye_across)), 1e-4);
    float half_around = sqrt(max(0.0, 0.5 + 0.5 * cos_around));
    float width = mix(0.30, 0.04, sharpness);
    float mirrored = 0.038 * lobe(half_angle + 0.10, width) * half_around;
    float returned = 0.32 * lobe(half_angle - 0.15, 2.0 * width) * half_around * half_around;
    float behind = max(0.0, -cos_around);
    float through = 0.35 * lobe(half_angle - 0.05, 1.5 * width + 0.1) * behind * behind * behind;
    float cos_light = sqrt(max(0.0, 1.0 - sin_light * sin_light));
    float skin = clamp(0.35 + 0.65 * dot(out_of, to_light), 0.0, 1.0);

    float reaching = key_light_on_surface(place, 0.5 * to_light) * mix(0.35, 1.0, open);
    vec3 glossy = shine / max(width, 0.05) * 0.35 * (vec3(mirrored) + albedo * (returned + through));
    vec3 sky = mix(FLOOR_LIGHT, SKY_LIGHT, 0.5 + 0.5 * out_of.y) + 0.35 * FILL_LIGHT;
    vec3 diffuse = albedo * cos_light * skin / PI;
    return open * albedo * sky + reaching * KEY_LIGHT * (diffuse + glossy * mix(0.3, 1.0, skin));
}
