// Cells around points that are scattered, one in each square of a grid (Worley, "A Cellular Texture Basis
// Function", 1996), closed around the body.
// vec2 cell_distances(vec2 place, int around): to the nearest and the second nearest point, in squares.

vec2 cell_distances(vec2 place, int around) {
    ivec2 square = ivec2(floor(place));
    vec2 nearest = vec2(9.0);
    for (int number = 0; number < 9; number++) {
        ivec2 other = square + ivec2(number % 3, number / 3) - 1;
        uint chance = pcg(uint(other.x) + pcg(uint((other.y + around) % around) + uint(pattern_start())));
        vec2 point = vec2(other) + 0.12 + 0.76 * vec2(chance & 0xffffu, chance >> 16u) / 65536.0;
        float away = length(place - point);
        if (away < nearest.x) nearest = vec2(away, nearest.x);
        else nearest.y = min(nearest.y, away);
    }
    return nearest;
}
