#version 330 core
// The spine at all moments of a beat, to be captured and measured: u_places places for each moment.
#include "fish/swim.glsl"

uniform int u_places;
uniform int u_moments;
uniform float u_turn;             // in degrees

out vec3 v_place;

void main() {
    float s = float(gl_VertexID % u_places) / float(u_places - 1);
    float phase = 6.2831853 * float(gl_VertexID / u_places) / float(u_moments);
    vec3 normal = vec3(0.0, 1.0, 0.0);
    v_place = vec3(MIDDLE - s, 0.0, 0.0);
    swim(v_place, normal, phase, radians(u_turn));
    gl_Position = vec4(0.0);
}
