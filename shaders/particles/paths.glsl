// The points of particles' paths.
// vec4 path_point(ivec2 slot, int point): a place, and in w the way to it from the path's start, in metres.
#include "generated/paths.glsl"

uniform sampler2D u_paths;
uniform sampler2D u_latest;         // the point that each path noted last

vec4 path_point(ivec2 slot, int point) {
    return texelFetch(u_paths, slot + PATH_SIZE * ivec2(point % PATH_COLUMNS, point / PATH_COLUMNS), 0);
}
