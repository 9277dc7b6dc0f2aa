#version 330 core

uniform sampler2D u_motion, u_velocity, u_nature, u_origin, u_launch;   // of the newborns

flat in ivec2 v_newborn;

layout(location = 0) out vec4 out_motion;
layout(location = 1) out vec4 out_velocity;
layout(location = 2) out vec4 out_nature;
layout(location = 3) out vec4 out_origin;
layout(location = 4) out vec4 out_launch;

void main() {
    out_motion = texelFetch(u_motion, v_newborn, 0);
    out_velocity = texelFetch(u_velocity, v_newborn, 0);
    out_nature = texelFetch(u_nature, v_newborn, 0);
    out_origin = texelFetch(u_origin, v_newborn, 0);
    out_launch = texelFetch(u_launch, v_newborn, 0);
}
