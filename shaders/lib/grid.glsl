// A grid of samples in a flat texture: row after row of the grid, u_grid_rows of them to a row of texels.
// vec3 grid_sample(vec2 texel): which sample the texel around this middle holds.   ivec2 grid_texel(ivec3 s): where it lies.
// vec3 grid_place(vec3 s): where samples, or places between them, sit in the function's own space.

uniform ivec3 u_grid_samples;     // how many samples along x, y, z
uniform int u_grid_rows;          // rows of samples that lie side by side in one row of the texture
uniform vec3 u_grid_corner;       // where sample (0, 0, 0) sits
uniform vec3 u_grid_step;         // from one sample to the next

vec3 grid_sample(vec2 texel) {
    // Whole numbers as floats, and quotients that stay off whole numbers: exact here, and fast.
    vec2 samples = vec2(u_grid_samples.xy);
    float beside = floor(texel.x / samples.x);
    float row = (texel.y - 0.5) * float(u_grid_rows) + beside;
    float z = floor((row + 0.5) / samples.y);
    return vec3(texel.x - 0.5 - beside * samples.x, row - z * samples.y, z);
}

ivec2 grid_texel(ivec3 s) {
    int row = s.y + s.z * u_grid_samples.y;
    int down = int((float(row) + 0.5) / float(u_grid_rows));
    return ivec2(s.x + (row - down * u_grid_rows) * u_grid_samples.x, down);
}

vec3 grid_place(vec3 s) {
    return u_grid_corner + s * u_grid_step;
}
