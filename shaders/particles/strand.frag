#version 330 core
// A strand, as it was lit at its points.

in vec4 v_light;

out vec4 out_color;

void main() {
    out_color = vec4(v_light.rgb, 1.0);
}
