// The rays of a fin, which run from its root outwards and fork, with a thin skin between them.
// Rays rays_at(vec2 place, float count): for a place along the root and outwards, each 0 to 1.

struct Rays {
    float ray;          // 1 on a ray to 0 in the middle between two
    float slope;        // how steeply the fin rises along its root
    float joint;        // 1 at the joints that make a ray bend
};

Rays rays_at(vec2 place, float count) {
    float angle = 6.2831853 * count * place.x;
    float single = 0.5 + 0.5 * cos(angle);
    float forked = 0.5 + 0.5 * cos(2.0 * angle);
    float fork = smoothstep(0.35, 0.85, place.y);
    float slope = -mix(sin(angle), sin(2.0 * angle), fork);
    float joint = 0.5 + 0.5 * cos(6.2831853 * 34.0 * place.y);
    return Rays(mix(single, forked, fork), slope, joint * smoothstep(0.3, 0.7, place.y));
}
