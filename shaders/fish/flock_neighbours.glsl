// What a fish makes of its neighbours: Reynolds' three rules.
// vec3 social_wish(int fish, vec3 place, vec3 velocity, int cell): the acceleration that they ask for, in m/s^2.
//
// The fish lie in the order of the cells of a grid, see viewer/kit/swim_cells.py, so that all near ones in a row of
// cells are one run.

uniform usampler2D u_seen;              // a fish as others see it: place, by the tank's half axes,
                                        // and velocity, by the fastest; two times three numbers in four
uniform usampler2D u_runs;              // for each cell: the first of its run, and the first beyond it
uniform ivec2 u_grid_size;              // cells along x and y
uniform vec3 u_school_half_axes;        // of the ellipsoid that nobody leaves
uniform float u_school_separation;
uniform float u_school_alignment;
uniform float u_school_cohesion;
uniform float u_school_perception;      // metres
uniform float u_per_perception_squared; // 1 over it squared, and
uniform float u_per_personal_space;     // 1 over that: multiplying is faster
uniform float u_school_fastest;         // metres a second

struct Neighbourhood {
    vec3 away;          // from those that are too near
    vec3 middle;        // towards all, the near ones counting more
    vec3 likeness;      // difference to their velocities, likewise
    float attention;    // how much all count
};

ivec2 run_of(int cell) {
    return ivec2(texelFetch(u_runs, ivec2(cell & CELLS_IN_ROW - 1, cell >> CELLS_ROW_BITS), 0).xy);
}

// Three numbers from -1 to 1, in 21 bits each.
vec3 unpacked(uvec2 bits) {
    uvec3 parts = uvec3(bits.x, bits.x >> 21u | bits.y << 11u, bits.y >> 10u) & 0x1fffffu;
    return vec3(ivec3(parts)) / 1048575.0 - 1.0;
}

void notice(inout Neighbourhood around, vec3 way, vec3 difference, float times) {
    float squared = dot(way, way), per_distance = inversesqrt(max(squared, 1e-12));
    float attention = times * max(0.0, 1.0 - squared * u_per_perception_squared);
    float crowding = max(0.0, 1.0 - squared * per_distance * u_per_personal_space);
    around.away -= (times * crowding * crowding * per_distance) * way;
    around.middle += attention * way;
    around.likeness += attention * difference;
    around.attention += attention;
}

// All in a row of cells. Where it is overcrowded a fish looks at every second or third only, who then counts twice or
// thrice: a school that collapses must not take forever.
void look_along(inout Neighbourhood around, int fish, vec3 place, vec3 velocity, int cell) {
    ivec2 run = run_of(cell);
    int stride = 1 + (run.y - run.x) / MOST_IN_RUN;
    for (int other = run.x; other < run.y; other += stride) {
        uvec4 seen = texelFetch(u_seen, ivec2(other & FISH_IN_ROW - 1, other >> FISH_ROW_BITS), 0);
        notice(around, unpacked(seen.xy) * u_school_half_axes - place, unpacked(seen.zw) * u_school_fastest - velocity,
               other == fish ? 0.0 : float(stride));
    }
}

vec3 social_wish(int fish, vec3 place, vec3 velocity, int cell) {
    Neighbourhood around = Neighbourhood(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            look_along(around, fish, place, velocity, cell + u_grid_size.x * (y + u_grid_size.y * z));
    float share = 1.0 / max(around.attention, 1.0);     // whoever sees next to nobody is not drawn with full force
    return u_school_separation * KEEPING_AWAY * around.away
        + u_school_alignment * LIKENESS * share * around.likeness
        + u_school_cohesion * SEEKING / u_school_perception * share * around.middle;
}
