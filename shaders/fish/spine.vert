#version 330 core
// A line along the fish's spine, as a ribbon that faces the eye: where it is now, where it was before, or how far it
// swings. Two vertices for each of u_places places; each instance is a line.
#include "lib/frame.glsl"
#include "fish/swim.glsl"
#include "fish/pose.glsl"

uniform int u_places;
uniform int u_ghosts;             // how many earlier moments of a beat are shown
uniform float u_width;            // of the line now, in pixels

out float v_along;                // 0 at the nose to 1 at the tail
out float v_across;               // -1 at one edge of the ribbon to 1 at the other
flat out int v_line;              // 0 now, 1 and 2 the envelope, from 3 on earlier moments

vec3 spine(float s, int line) {
    FishPose pose = fish_pose(0);
    if (line == 1 || line == 2) {
        vec3 still = vec3(MIDDLE - s, 0.0, u_swim_amplitude * swing(s).x * (line == 1 ? 1.0 : -1.0));
        return place_of(pose, still);
    }
    float earlier = line == 0 ? 0.0 : 6.2831853 * float(line - 2) / float(u_ghosts + 1);
    vec3 place = vec3(MIDDLE - s, 0.0, 0.0), normal = vec3(0.0, 1.0, 0.0);
    swim(place, normal, pose.phase - earlier, pose.bend);
    return place_of(pose, place);
}

void main() {
    v_along = float(gl_VertexID / 2) / float(u_places - 1);
    v_line = 2 + u_ghosts - gl_InstanceID;     // the oldest first, so that the line now lies over all
    vec4 here = u_frame.view_projection * vec4(spine(v_along, v_line), 1.0);
    vec4 next = u_frame.view_projection * vec4(spine(v_along + 1e-3, v_line), 1.0);
    vec2 way = (next.xy / next.w - here.xy / here.w) * u_frame.resolution;
    vec2 aside = length(way) > 0.0 ? normalize(vec2(-way.y, way.x)) : vec2(0.0, 1.0);
    v_across = (gl_VertexID & 1) == 0 ? 1.0 : -1.0;
    float width = u_width * (v_line == 0 ? 1.0 : 0.32);
    gl_Position = here + vec4(v_across * width * aside / u_frame.resolution * here.w, 0.0, 0.0);
}
