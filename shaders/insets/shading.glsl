// Light on models: bright enough to read, round enough to see their shape.
// vec3 model_light(vec3 normal, vec3 to_eye, vec3 color): color is linear.
#include "lib/frame.glsl"

vec3 model_light(vec3 normal, vec3 to_eye, vec3 color) {
    float key = max(dot(normal, normalize(u_frame.key_direction + 0.8 * to_eye)), 0.0);
    vec3 halfway = normalize(normalize(u_frame.key_direction + to_eye) + to_eye);
    float shine = pow(max(dot(normal, halfway), 0.0), 40.0);
    return color * (0.34 + 0.72 * key) + 0.10 * shine;
}
