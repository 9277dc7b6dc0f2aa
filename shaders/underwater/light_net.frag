#version 330 core
// Where the net is drawn together the floor is brighter: by the area of water whose light lands on this pixel,
// for all layers of the net that lie over each other here (Wallace, "Rendering Realtime Caustics in WebGL", 2016).

const float MOST = 10.0;          // of a mesh drawn together to less than a pixel, which may miss it or not

uniform float u_pixel;            // the side of a pixel, in tiles

in vec2 v_start;

out vec4 out_light;

void main() {
    vec2 across = dFdx(v_start), along = dFdy(v_start);
    float area = abs(across.x * along.y - across.y * along.x);
    out_light = vec4(min(area / (u_pixel * u_pixel), MOST));
}
