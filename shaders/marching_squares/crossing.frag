#version 330 core
// White with a dark rim.

in vec2 v_from_middle;
flat in float v_radius;

out vec4 out_color;

void main() {
    float inwards = v_radius - length(v_from_middle);
    vec3 color = mix(vec3(0.01), vec3(0.95), clamp(0.5 + inwards - 0.3 * v_radius, 0.0, 1.0));
    out_color = vec4(color, clamp(0.5 + inwards, 0.0, 1.0));
}
