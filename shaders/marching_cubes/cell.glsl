// What marching makes of the cell around a place: its samples, its case, what tetrahedra would say.
// Needs lib/grid.glsl. float cell_case(vec3 s); float tetrahedra_value(vec3 s); float trilinear_value(vec3 s):
// s is a place in samples; values are less the level.

uniform sampler2D u_values;
uniform float u_surface_level;

float corner_value(ivec3 cell, int corner) {
    ivec3 s = cell + ivec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    return texelFetch(u_values, grid_texel(s), 0).r - u_surface_level;
}

ivec3 cell_of(vec3 s) {
    return clamp(ivec3(floor(s)), ivec3(0), u_grid_samples - 2);
}

int cell_case(vec3 s) {
    ivec3 cell = cell_of(s);
    int number = 0;
    for (int corner = 0; corner < 8; corner++)
        if (corner_value(cell, corner) < 0.0)
            number |= 1 << corner;
    return number;
}

float trilinear_value(vec3 s) {
    ivec3 cell = cell_of(s);
    vec3 within = s - vec3(cell);
    float value = 0.0;
    for (int c = 0; c < 8; c++) {
        vec3 share = mix(1.0 - within, within, vec3(c & 1, c >> 1 & 1, c >> 2 & 1));
        value += share.x * share.y * share.z * corner_value(cell, c);
    }
    return value;
}

// Linear inside each of the six tetrahedra: from corner 0 along the axes in the order of how far one goes.
float tetrahedra_value(vec3 s) {
    ivec3 cell = cell_of(s);
    vec3 within = s - vec3(cell);
    int first = within.x >= within.y ? (within.x >= within.z ? 0 : 2) : (within.y >= within.z ? 1 : 2);
    int last = within.x < within.y ? (within.x < within.z ? 0 : 2) : (within.y < within.z ? 1 : 2);
    if (first == last) { first = 0; last = 2; }           // all the same
    int second = 3 - first - last;
    float a = within[first], b = within[second], c = within[last];
    return (1.0 - a) * corner_value(cell, 0) + (a - b) * corner_value(cell, 1 << first)
        + (b - c) * corner_value(cell, 1 << first | 1 << second) + c * corner_value(cell, 7);
}
