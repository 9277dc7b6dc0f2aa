#version 330 core
// A letter's pixels are copied from the sheet, one to one; a plate is a rectangle with round corners.

uniform sampler2D u_sheet;

flat in vec4 v_rectangle;
flat in vec2 v_sheet;
flat in float v_radius;
flat in vec4 v_color;

out vec4 out_color;

// How much of the pixel at `place`, from the lower left corner, the plate covers: its distance tells.
float plate(vec2 place) {
    vec2 beyond = abs(place - 0.5 * v_rectangle.zw) - 0.5 * v_rectangle.zw + v_radius;
    float outside = length(max(beyond, 0.0)) + min(max(beyond.x, beyond.y), 0.0) - v_radius;
    return clamp(0.5 - outside, 0.0, 1.0);
}

void main() {
    vec2 place = gl_FragCoord.xy - v_rectangle.xy;
    float coverage = v_radius < 0.0 ? texelFetch(u_sheet, ivec2(v_sheet + place), 0).r : plate(place);
    out_color = vec4(v_color.rgb, v_color.a * coverage);
}
