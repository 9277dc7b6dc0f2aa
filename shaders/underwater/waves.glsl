// The waves on the water above: travelling sines that repeat, without a seam, on a square tile.
// vec2 wave_slope(vec2 place, float time): how steeply the water rises at a place of the tile, 0 to 1 across it.

const int WAVES = 7;
// How often a wave repeats across and along the tile, how steep it is, and where it starts.
const vec4 WAVE_LIST[WAVES] = vec4[](
    vec4(2.0, 1.0, 0.92, 0.0), vec4(-1.0, 3.0, 0.74, 1.7), vec4(3.0, -2.0, 0.66, 4.1), vec4(-4.0, -1.0, 0.50, 2.6),
    vec4(1.0, -5.0, 0.40, 5.3), vec4(5.0, 4.0, 0.30, 0.9), vec4(-6.0, 5.0, 0.22, 3.4));
const float TURN = 6.2831853;

vec2 wave_slope(vec2 place, float time) {
    vec2 slope = vec2(0.0);
    for (int number = 0; number < WAVES; number++) {
        vec2 repeats = WAVE_LIST[number].xy;
        // Long waves run faster, short ones turn over faster: over deep water as the root of their number.
        float pace = 0.9 * sqrt(length(repeats));
        float phase = TURN * dot(repeats, place) + WAVE_LIST[number].w - pace * time;
        slope += normalize(repeats) * WAVE_LIST[number].z * cos(phase);
    }
    return slope;
}
