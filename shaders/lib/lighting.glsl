// The studio's light on a surface: a warm key with soft shadow, a cool fill, a rim, and the sky.
// vec3 studio_light(vec3 position, vec3 normal, vec3 albedo, float roughness): linear light to the eye.
#include "lib/frame.glsl"
#include "lib/shadow.glsl"

const float PI = 3.14159265;
const vec3 KEY_LIGHT = vec3(3.1, 2.9, 2.6);
const vec3 FILL_LIGHT = vec3(0.24, 0.30, 0.40);
const vec3 SKY_LIGHT = vec3(0.36, 0.40, 0.47);
const vec3 FLOOR_LIGHT = vec3(0.20, 0.19, 0.18);

// Light mirrored by microscopic facets: the GGX distribution of Walter et al. 2007,
// with the visibility term of Schlick 1994 and his Fresnel approximation.
float glossy_reflection(vec3 normal, vec3 to_light, vec3 to_eye, float roughness) {
    vec3 halfway = normalize(to_light + to_eye);
    float alpha = roughness * roughness;
    float facing = max(dot(normal, halfway), 0.0);
    float spread = facing * facing * (alpha * alpha - 1.0) + 1.0;
    float distribution = alpha * alpha / (PI * spread * spread);
    float k = 0.5 * alpha;
    float seen = max(dot(normal, to_eye), 0.0) * (1.0 - k) + k;
    float lit = max(dot(normal, to_light), 0.0) * (1.0 - k) + k;
    float away = 1.0 - max(dot(to_eye, halfway), 0.0);
    float fresnel = 0.04 + 0.96 * away * away * away * away * away;     // products are faster than pow
    return distribution * fresnel / (4.0 * seen * lit);
}

vec3 studio_light(vec3 position, vec3 normal, vec3 albedo, float roughness) {
    vec3 to_eye = normalize(u_frame.eye - position);
    float facing_key = dot(normal, u_frame.key_direction);
    vec3 light = albedo * mix(FLOOR_LIGHT, SKY_LIGHT, 0.5 + 0.5 * normal.y);

    vec3 fill_direction = normalize(vec3(0.8, 0.15, 0.5));
    light += albedo * FILL_LIGHT * max(dot(normal, fill_direction), 0.0);

    if (facing_key > 0.0) {
        float reaching = key_light_on_surface(position, normal);
        vec3 mirrored = vec3(glossy_reflection(normal, u_frame.key_direction, to_eye, roughness));
        light += KEY_LIGHT * facing_key * reaching * (albedo / PI + mirrored);
    }
    float grazing = 1.0 - max(dot(normal, to_eye), 0.0);
    light += 0.35 * SKY_LIGHT * grazing * grazing * grazing * (0.5 + 0.5 * normal.y);
    return light;
}
