// What moves a particle.
// vec3 force_acceleration(vec3 place, float mass): of all forces but drag, in m/s^2.
// vec3 air_velocity(vec3 place): how the air moves that drag drags along, in m/s.
#include "generated/forces.glsl"
#include "lib/curl_noise.glsl"

uniform float u_time;               // scene time at the middle of the step, in seconds
uniform float u_gravity;
uniform vec3 u_wind_velocity;
uniform float u_gusts;
uniform float u_turbulence;
uniform float u_turbulence_size;
uniform float u_turbulence_pace;
uniform vec3 u_attractor_place;
uniform float u_attraction;
uniform float u_attractor_core;
uniform float u_vortex;

// Towards a point as the inverse square of the distance, towards a vertical line as its inverse;
// softened within the core, where a real body would have its surface.
vec3 attraction(vec3 from) {
    if (ATTRACTOR == ATTRACTOR_LINE)
        from.y = 0.0;
    float squared = dot(from, from) + u_attractor_core * u_attractor_core;
    return -u_attraction * from / (ATTRACTOR == ATTRACTOR_POINT ? squared * sqrt(squared) : squared);
}

// Around the vertical through the attractor's place: strongest at the rim of the core, fading as 1/r beyond.
vec3 swirl(vec3 from) {
    float squared = dot(from.xz, from.xz) + u_attractor_core * u_attractor_core;
    return 2.0 * u_vortex * u_attractor_core * vec3(from.z, 0.0, -from.x) / squared;
}

vec3 turbulence_force(vec3 place) {
    vec3 drift = u_turbulence_pace * u_time * vec3(0.31, 0.83, -0.46);
    return u_turbulence * curl_noise(place / u_turbulence_size + drift);
}

vec3 force_acceleration(vec3 place, float mass) {
    vec3 acceleration = vec3(0.0, -u_gravity, 0.0);
    vec3 from = place - u_attractor_place;
    if (ATTRACTOR != ATTRACTOR_NONE)
        acceleration += attraction(from);
    if (HAS_VORTEX)
        acceleration += swirl(from);
    if (HAS_TURBULENCE)
        acceleration += turbulence_force(place) / mass;
    return acceleration;
}

// Gusts travel with the wind: two waves of different length, never quite in step.
float gust(vec3 place) {
    vec3 wind = u_wind_velocity;
    float along = dot(place, wind) / max(length(wind), 1e-6) - length(wind) * u_time;
    return 1.0 + u_gusts * (0.6 * sin(1.1 * along + 0.7 * place.z) + 0.4 * sin(2.7 * along - 1.3 * place.x + 1.9));
}

vec3 air_velocity(vec3 place) {
    return HAS_GUSTS ? u_wind_velocity * gust(place) : u_wind_velocity;
}
