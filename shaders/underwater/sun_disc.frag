#version 330 core
// The sun is a disc: its light makes lines that are a little soft. Four looks between texels weigh sixteen of them.

uniform sampler2D u_light;

out vec4 out_light;

void main() {
    vec2 size = vec2(textureSize(u_light, 0));
    float sum = 0.0;
    for (int number = 0; number < 4; number++) {
        vec2 aside = 1.5 * (vec2(number & 1, number >> 1) - 0.5);
        sum += 0.25 * texture(u_light, (gl_FragCoord.xy + aside) / size).r;
    }
    out_light = vec4(sum);
}
