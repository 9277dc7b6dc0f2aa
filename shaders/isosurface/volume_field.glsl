// A field known by its samples only: between them, the trilinear interpolation of values and of slopes.
// float field(vec3 place);   vec3 field_gradient(vec3 place).   Needs lib/grid.glsl.

uniform sampler2D u_volume;

float volume_sample(ivec3 s) {
    return texelFetch(u_volume, grid_texel(clamp(s, ivec3(0), u_grid_samples - 1)), 0).r;
}

// Differences between the samples on either side; at the border, between the last and the one before.
vec3 volume_slope(ivec3 s) {
    vec3 slope;
    for (int axis = 0; axis < 3; axis++) {
        ivec3 aside = ivec3(axis == 0, axis == 1, axis == 2);
        ivec3 before = max(s - aside, ivec3(0)), after = min(s + aside, u_grid_samples - 1);
        slope[axis] = (volume_sample(after) - volume_sample(before)) / (float(after[axis] - before[axis]) * u_grid_step[axis]);
    }
    return slope;
}

// The share of a cell's corner in a place inside the cell. Most are 0 where a vertex lies on an edge.
float share_of(ivec3 corner, vec3 within) {
    vec3 share = mix(1.0 - within, within, vec3(corner));
    return share.x * share.y * share.z;
}

float field(vec3 place) {
    vec3 s = clamp((place - u_grid_corner) / u_grid_step, vec3(0.0), vec3(u_grid_samples - 1));
    ivec3 cell = min(ivec3(s), u_grid_samples - 2);
    float value = 0.0;
    for (int c = 0; c < 8; c++) {
        ivec3 corner = ivec3(c & 1, c >> 1 & 1, c >> 2 & 1);
        value += share_of(corner, s - vec3(cell)) * volume_sample(cell + corner);
    }
    return value;
}

vec3 field_gradient(vec3 place) {
    vec3 s = clamp((place - u_grid_corner) / u_grid_step, vec3(0.0), vec3(u_grid_samples - 1));
    ivec3 cell = min(ivec3(s), u_grid_samples - 2);
    vec3 slope = vec3(0.0);
    for (int c = 0; c < 8; c++) {
        ivec3 corner = ivec3(c & 1, c >> 1 & 1, c >> 2 & 1);
        float share = share_of(corner, s - vec3(cell));
        if (share > 1e-3)
            slope += share * volume_slope(cell + corner);
    }
    return slope;
}
