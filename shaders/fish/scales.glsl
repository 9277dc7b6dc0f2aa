// Scales in staggered rows, like tiles on a roof: each lies over the front of the one behind it.
// Scale scale_at(vec2 place): the scale on top at a place, given in rows from the nose and in columns around.
// vec3 tilted(vec3 normal, vec3 ahead, vec2 slope): the normal where the skin of a fish that swims ahead rises by a
// slope along the surface towards the tail, and across that.

uniform int u_columns;            // scales around the body

struct Scale {
    vec2 slope;         // how steeply the skin rises towards the tail and around, on the scale's own scale
    float rim;          // 1 in the seam at the scale's rim, 0 elsewhere
    uint identity;      // for what differs from scale to scale
};

const float SCALE_RADIUS = 0.72;  // in columns; rows follow each other by half a column

Scale scale_at(vec2 place) {
    Scale scale = Scale(vec2(0.0), 0.0, 0u);
    float newest = floor(2.0 * place.x);
    for (int older = 0; older <= 2; older++) {       // those in front lie on top, so they have the last word
        float row = newest - float(older);
        float stagger = 0.5 * mod(row, 2.0);
        float column = floor(place.y - stagger + 0.5);
        vec2 inside = (place - vec2(0.5 * row, column + stagger)) / SCALE_RADIUS;
        float away = length(inside);
        if (away < 1.0) {
            float edge = smoothstep(0.80, 1.0, away);
            scale.slope = vec2(0.55 * inside.x - 0.9 * edge, -0.75 * inside.y);
            scale.rim = edge;
            scale.identity = pcg(uint(int(row)) + pcg(uint(int(mod(column, float(u_columns))))));
        }
    }
    return scale;
}

vec3 tilted(vec3 normal, vec3 ahead, vec2 slope) {
    vec3 along = normal * dot(ahead, normal) - ahead;
    along /= max(length(along), 1e-6);      // at the tip of the nose no way along the surface leads to the tail
    return normalize(normal - slope.x * along - slope.y * cross(along, normal));
}
