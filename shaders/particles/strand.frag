#version 330 core
// A strand, as it was lit at its points; its alpha tells how many of a pixel's samples it covers.

in vec4 v_light;

out vec4 out_color;

void main() {
    out_color = v_light;
}
