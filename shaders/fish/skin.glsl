// What is known of a spot on the fish at rest, and of the skin there. A species' file gives, from this,
// vec3 coat(Spot spot): the colour of its pattern.
// Skin body_skin(Spot spot, vec3 coat); Fin fin_skin(Spot spot, int part, vec2 place, vec3 coat): what is made of it.
// IRIS, the colour of its eyes; FIN_SLANT, how far the pattern of its dorsal fin leans back towards the tip.

struct Spot {
    vec3 rest;          // metres, the nose at x = 0.5, the back towards +y
    float along;        // 0 at the nose to 1 at the tail's tip
    float back;         // 1 at the back, 0 in the middle of the flank, -1 at the belly
    vec2 lattice;       // along and around the body, in girths: 1 once around
    float pixel;        // the width of a pixel there, in body lengths
};

struct Skin {
    vec3 color;
    float mirror;       // 1 is wet skin, more is silver
    float roughness;
    float film;         // how much the mirrored light is coloured by thin layers, 0 to 1
    float scales;       // how clearly scales show, 0 to 1
};

struct Fin {
    vec3 color;
    float cover;        // 0 clear as glass to 1 opaque
};

// 0 where a distance is negative to 1 where it is positive, smooth over a pixel or over `blur` where that is more.
float beyond(float distance, float blur, Spot spot) {
    float width = max(blur, spot.pixel);
    return smoothstep(-width, width, distance);
}
