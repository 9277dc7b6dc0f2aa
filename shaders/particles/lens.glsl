// Distances in front of the eye, from the projection alone.
// float distance_at(float depth): metres at a window depth from 0 to 1; float depth_at(float away): the inverse.
// float nearest(), farthest(): the planes.
// float pixels_per_slope(): how many pixels high something is that is as high as it is distant.
#include "lib/frame.glsl"

float distance_at(float depth) {
    return u_frame.projection[3][2] / (2.0 * depth - 1.0 + u_frame.projection[2][2]);
}

float depth_at(float away) {
    return 0.5 + 0.5 * (u_frame.projection[3][2] / away - u_frame.projection[2][2]);
}

float nearest() { return distance_at(0.0); }
float farthest() { return distance_at(1.0); }

float pixels_per_slope() {
    return 0.5 * u_frame.projection[1][1] * u_frame.resolution.y;
}
