#version 330 core
// A speck of dust, as a small square that faces the eye; it drifts, and comes in again where it left.
#include "lib/underwater.glsl"
#include "particles/random.glsl"

out vec2 v_place;
out float v_light;

void main() {
    uint mote = uint(gl_InstanceID);
    vec3 chance = vec3(random_of(mote, 0u), random_of(mote, 1u), random_of(mote, 2u));
    vec3 drift = vec3(0.016, -0.006, 0.009) * (0.5 + random_of(mote, 3u));
    vec3 inside = fract(chance + drift * u_frame.time);
    float size = mix(0.0016, 0.0042, random_of(mote, 4u)) * u_frame.radius;
    vec3 middle = u_frame.center + u_frame.radius * (vec3(3.2, 1.9, 3.2) * (inside - 0.5) + vec3(0.0, 0.45, 0.0));

    v_place = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec3 edge = 4.0 * inside * (1.0 - inside);
    v_light = edge.x * edge.y * edge.z * mix(0.4, 1.0, random_of(mote, 5u)) * mix(0.6, 1.4, soft_caustic_light(middle));
    vec4 seen = u_frame.view * vec4(middle, 1.0);
    v_light *= smoothstep(0.3, 0.7, -seen.z / u_frame.radius);
    gl_Position = u_frame.projection * (seen + vec4(size * v_place, 0.0, 0.0));
}
