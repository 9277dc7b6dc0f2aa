// What is in a fish's face, drawn where the body is formed so: the edge of the gill cover, mouth and nostrils.
// Face face_at(Spot spot): how dark each makes the skin.
// From generated/fish.glsl, in metres of the fish at rest: GILL (the place farthest back, how it curls forward, how
// far up and down it reaches), MOUTH_TIP, MOUTH_CORNER, MOUTH_GAPE, EYE_PLACE and EYE_RADIUS.

struct Face {
    float bare;         // 1 on the snout, where there are no scales, less on the cheeks, 0 on the body
    float crease;       // 1 in the gap behind the gill cover
    float lips;         // 1 on the lips
    float gap;          // 1 between them, and in the nostrils
};

Face face_at(Spot spot) {
    float aside = spot.rest.y - GILL.y;
    float behind = GILL.x + GILL.z * aside * aside - spot.rest.x;
    float fade = 1.0 - smoothstep(0.55, 1.0, abs(aside) / GILL.w);
    float crease = fade * smoothstep(-0.004, 0.002, behind) * (1.0 - smoothstep(0.003, 0.012, behind));
    float cheek = 1.0 - smoothstep(0.0, 0.02, behind);
    float bare = cheek * mix(0.55, 1.0, smoothstep(EYE_PLACE.x - 2.5 * EYE_RADIUS, EYE_PLACE.x, spot.rest.x));

    vec2 mouth = MOUTH_CORNER - MOUTH_TIP;
    float share = (spot.rest.x - MOUTH_TIP.x) / mouth.x;      // 0 at the tip to 1 in the corner
    float line = (spot.rest.y - MOUTH_TIP.y - share * mouth.y) / MOUTH_GAPE;
    float inside = 1.0 - smoothstep(0.85, 1.05, share);
    float lips = inside * (1.0 - smoothstep(1.8, 3.6, abs(line)));
    float gap = inside * (1.0 - smoothstep(0.45, 0.95 + 0.7 * spot.pixel / MOUTH_GAPE, abs(line)));
    vec2 nostril = mix(EYE_PLACE, MOUTH_TIP, 0.52) + vec2(0.0, 0.62 * EYE_RADIUS);
    float away = length((spot.rest.xy - nostril) * vec2(0.8, 1.3) / EYE_RADIUS);
    gap = max(gap, 1.0 - smoothstep(0.05, 0.15 + spot.pixel / EYE_RADIUS, away));
    return Face(bare, crease, lips, gap);
}
