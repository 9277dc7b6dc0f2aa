#version 330 core
// Where a particle now is, and how far it has come: one more point of its path.

uniform sampler2D u_motion, u_nature, u_origin;     // see step.frag
uniform sampler2D u_before;                         // the point before: a place, and in w the way to it
uniform float u_since;                              // how long ago that was, in seconds

out vec4 out_point;

void main() {
    ivec2 slot = ivec2(gl_FragCoord.xy);
    vec4 motion = texelFetch(u_motion, slot, 0);
    vec4 before = texelFetch(u_before, slot, 0);
    float age = texelFetch(u_nature, slot, 0).x - motion.w;
    vec3 birthplace = texelFetch(u_origin, slot, 0).xyz;
    bool same_life = age > u_since;
    float way = same_life ? before.w + distance(motion.xyz, before.xyz) : distance(motion.xyz, birthplace);
    out_point = vec4(motion.xyz, way);
}
