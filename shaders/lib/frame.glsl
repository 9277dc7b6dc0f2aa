// What every shader may know of the moment: camera, time, light and set, as u_frame.view and so on.
// Written once for each pass by the engine; the layout follows the std140 rules.

layout(std140) uniform Frame {
    mat4 view;               // world to camera
    mat4 projection;         // camera to clip space
    mat4 view_projection;    // world to clip space
    mat4 clip_to_world;
    mat4 world_to_shadow;    // world to the shadow map: across, up, depth, each 0 to 1
    vec3 eye;                // the camera, in the world
    float time;              // scene time, in seconds
    vec2 resolution;         // the picture, in pixels
    float number;            // scene time, in frames
    float has_ground;        // 1 with a floor, 0 without
    vec3 key_direction;      // from the scene towards the key light
    float ground_height;
    vec3 center;             // the sphere that holds the scene: its centre
    float radius;            // and its radius
    vec4 backdrop_low;       // the wall's colour at the bottom of the picture, linear
    vec4 backdrop_high;      // and at the top
} u_frame;
