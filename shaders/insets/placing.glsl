// Where parts of a model appear: in the world, or in a frame of the picture that turns with the camera.
// vec4 placed(vec3 p, vec3 frame): clip space; frame = (across, up, size), size 0 for the world.
#include "lib/frame.glsl"

vec4 placed(vec3 p, vec3 frame) {
    if (frame.z == 0.0)
        return u_frame.view_projection * vec4(p, 1.0);
    vec3 turned = mat3(u_frame.view) * (p - 0.5);
    float aspect = u_frame.resolution.x / u_frame.resolution.y;
    // In front of everything in the world, but not so flat that parts of the model could not hide each other.
    float depth = -0.9 - 0.04 * turned.z;
    return vec4(frame.xy + frame.z * turned.xy / vec2(aspect, 1.0), depth, 1.0);
}

// The direction to the eye.
vec3 towards_eye(vec3 p, vec3 frame) {
    vec3 backwards = vec3(u_frame.view[0][2], u_frame.view[1][2], u_frame.view[2][2]);
    return frame.z == 0.0 ? normalize(u_frame.eye - p) : backwards;
}
