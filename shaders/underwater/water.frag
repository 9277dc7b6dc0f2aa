#version 330 core
// The water behind all, with soft shafts where more light comes down than beside them.
#include "lib/underwater.glsl"

in vec2 v_place;

out vec4 out_color;

const int STEPS = 6;

// The light gathered on the way of a look through the water, 1 on average.
float shafts(vec3 direction) {
    float sum = 0.0;
    float first = max(length(u_frame.eye - u_frame.center) - u_frame.radius, 0.0);
    for (int number = 0; number < STEPS; number++) {
        float away = first + u_frame.radius * (0.5 + 1.1 * float(number));
        sum += soft_caustic_light(u_frame.eye + away * direction);
    }
    return sum / float(STEPS);
}

void main() {
    vec4 far = u_frame.clip_to_world * vec4(v_place, 1.0, 1.0);
    vec3 direction = normalize(far.xyz / far.w - u_frame.eye);
    float above = smoothstep(-0.05, 0.35, direction.y);
    out_color = vec4(water_color(direction) * mix(1.0, shafts(direction), 0.85 * above), 1.0);
}
