#version 330 core
// Everyone back at birth, about to live a whole life in equal steps.

uniform sampler2D u_motion, u_velocity, u_nature, u_origin, u_launch;   // see step.frag
uniform float u_part;               // of the life in a step

layout(location = 0) out vec4 out_motion;
layout(location = 1) out vec4 out_velocity;
layout(location = 2) out vec4 out_origin;

void main() {
    ivec2 slot = ivec2(gl_FragCoord.xy);
    vec4 origin = texelFetch(u_origin, slot, 0);
    float lifetime = texelFetch(u_nature, slot, 0).x;
    bool lives = texelFetch(u_motion, slot, 0).w > 0.0;
    out_motion = vec4(origin.xyz, lives ? lifetime : 0.0);
    out_velocity = vec4(texelFetch(u_launch, slot, 0).xyz, abs(texelFetch(u_velocity, slot, 0).w));
    out_origin = vec4(origin.xyz, u_part * lifetime);
}
