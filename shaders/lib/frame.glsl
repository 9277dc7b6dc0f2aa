// What every shader may know of the moment: camera, time, light and set.
// Written once for each pass by the engine; the layout follows the std140 rules.

layout(std140) uniform Frame {
    mat4 u_view;               // world to camera
    mat4 u_projection;         // camera to clip space
    mat4 u_view_projection;    // world to clip space
    mat4 u_clip_to_world;
    mat4 u_world_to_shadow;    // world to the shadow map: across, up, depth, each 0 to 1
    vec3 u_eye;                // the camera, in the world
    float u_time;              // scene time, in seconds
    vec2 u_resolution;         // the picture, in pixels
    float u_frame;             // scene time, in frames
    float u_padding;
    vec3 u_key_direction;      // from the scene towards the key light
    float u_ground_height;
    vec3 u_center;             // the sphere that holds the scene: its centre
    float u_radius;            // and its radius
    vec3 u_backdrop_low;
    float u_has_ground;        // 1 with a floor, 0 without
    vec3 u_backdrop_high;
    float u_padding_too;
};
