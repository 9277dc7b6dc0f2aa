// A grid of samples in a flat texture: row after row of the grid, u_grid_rows of them to a row of texels.
// ivec3 grid_sample(ivec2 texel): which sample a texel holds.   ivec2 grid_texel(ivec3 s): where it lies.
// vec3 grid_place(vec3 s): where samples, or places between them, sit in the function's own space.

uniform ivec3 u_grid_samples;     // how many samples along x, y, z
uniform int u_grid_rows;          // rows of samples that lie side by side in one row of the texture
uniform vec3 u_grid_corner;       // where sample (0, 0, 0) sits
uniform vec3 u_grid_step;         // from one sample to the next

ivec3 grid_sample(ivec2 texel) {
    // Quotients of whole numbers by way of floats: exact here, and faster than dividing integers.
    int beside = int((float(texel.x) + 0.5) / float(u_grid_samples.x));
    int row = texel.y * u_grid_rows + beside;
    int z = int((float(row) + 0.5) / float(u_grid_samples.y));
    return ivec3(texel.x - beside * u_grid_samples.x, row - z * u_grid_samples.y, z);
}

ivec2 grid_texel(ivec3 s) {
    int row = s.y + s.z * u_grid_samples.y;
    int down = int((float(row) + 0.5) / float(u_grid_rows));
    return ivec2(s.x + (row - down * u_grid_rows) * u_grid_samples.x, down);
}

vec3 grid_place(vec3 s) {
    return u_grid_corner + s * u_grid_step;
}
