#version 330 core
// Sand that the water has laid in ripples, under moving lines of light and the shadow of what swims above.
#include "lib/underwater.glsl"
#include "particles/random.glsl"

in vec3 v_position;

out vec4 out_color;

uniform int u_water;              // 0 lagoon, 1 ocean, 2 pond

// White sand, paler deep down, dark gravel in a pond.
const vec3 SAND[3] = vec3[](vec3(0.53, 0.44, 0.32), vec3(0.46, 0.43, 0.38), vec3(0.17, 0.19, 0.145));
const float RIPPLES = 19.0;       // radians a metre

// What bends the ripples: long waves across the sand, their slope along x and z and their height.
vec3 wandering(vec2 place) {
    const vec4 waves[4] = vec4[](vec4(1.3, 0.7, 0.55, 0.4), vec4(-0.9, 2.0, 0.35, 2.9), vec4(3.1, -1.7, 0.16, 5.1),
                                 vec4(2.3, 4.9, 0.10, 1.2));
    vec3 sum = vec3(0.0);
    for (int number = 0; number < 4; number++) {
        float phase = dot(waves[number].xy, place) + waves[number].w;
        sum += waves[number].z * vec3(waves[number].xy * cos(phase), sin(phase));
    }
    return sum;
}

// How steeply the sand rises along x and z, and its height, for ripples that wander.
vec3 sand_at(vec2 place) {
    const vec2 way = vec2(0.38, 0.92);
    vec3 wander = wandering(place);
    float phase = RIPPLES * dot(way, place) + 3.4 * wander.z;
    vec2 phase_slope = RIPPLES * way + 3.4 * wander.xy;
    float strength = 0.65 + 0.4 * wander.z;
    // Crests sharper than troughs.
    float height = strength * (sin(phase) + 0.22 * sin(2.0 * phase + 0.9));
    return vec3(0.024 * strength * (cos(phase) + 0.44 * cos(2.0 * phase + 0.9)) * phase_slope, height);
}

void main() {
    float away = length(u_frame.eye - v_position);
    float near = exp(-0.10 * away * away / (5.0 * u_frame.radius * u_frame.radius + 1.5));
    float scale = max(1.0, 0.5 * u_frame.radius);       // coarser where all is seen from farther away
    vec3 sand = sand_at(v_position.xz / scale);
    vec2 slope = sand.xy * mix(0.35, 1.0, near);
    vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
    ivec2 grain_place = ivec2(floor(v_position.xz * 420.0 / scale));
    float grain = random_of(pcg(uint(grain_place.x)) + uint(grain_place.y), 0u) - 0.5;
    vec3 albedo = SAND[u_water] * (1.0 + 0.16 * sand.z + (u_water == 2 ? 0.5 : 0.16) * grain * near);

    float facing = max(dot(normal, u_frame.key_direction), 0.0);
    float reaching = key_light_on_floor(v_position);
    float gathered = mix(1.0, caustic_light(v_position), 0.55 * mix(0.45, 1.0, near));
    vec3 below = vec3(u_frame.center.x, u_frame.ground_height, u_frame.center.z);
    float hidden = 1.0 - 0.30 * (1.0 - smoothstep(0.0, 1.0, length(v_position - below) / u_frame.radius));
    vec3 light = albedo * u_frame.backdrop_high.rgb * 1.1 * hidden * (0.7 + 0.3 * normal.y);
    light += albedo / PI * SUN * facing * reaching * gathered;
    out_color = vec4(veiled(light, v_position), 1.0);
}
