// Numbers of one or two digits, drawn as strokes, sharp at any size.
// float number_distance(vec2 p, int number): from p to the nearest stroke, the number 1 high and centred at 0.

float stroke(vec2 p, vec2 a, vec2 b) {
    vec2 along = b - a;
    return length(p - a - along * clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0));
}

// The outline of a rectangle of half extent `reach` with round corners.
float ring(vec2 p, vec2 centre, vec2 reach, float radius) {
    vec2 out_by = abs(p - centre) - reach + radius;
    return abs(length(max(out_by, 0.0)) + min(max(out_by.x, out_by.y), 0.0) - radius);
}

// Half of such an outline: the part right of its centre.
float bow(vec2 p, vec2 centre, vec2 reach, float radius) {
    float end = min(length(p - centre - vec2(0.0, reach.y)), length(p - centre + vec2(0.0, reach.y)));
    return p.x > centre.x ? ring(p, centre, reach, radius) : end;
}

float digit_distance(vec2 p, int digit) {
    if (digit == 9) { p = -p; digit = 6; }
    if (digit == 0) return ring(p, vec2(0.0), vec2(0.27, 0.5), 0.27);
    if (digit == 1) return min(stroke(p, vec2(0.06, -0.5), vec2(0.06, 0.5)), stroke(p, vec2(0.06, 0.5), vec2(-0.16, 0.32)));
    if (digit == 2) {
        float curl = p.y > 0.24 ? ring(p, vec2(0.0, 0.24), vec2(0.26), 0.26) : 9.0;
        float down = min(stroke(p, vec2(0.255, 0.2), vec2(-0.28, -0.5)), length(p - vec2(-0.26, 0.24)));
        return min(min(curl, down), stroke(p, vec2(-0.28, -0.5), vec2(0.28, -0.5)));
    }
    if (digit == 3) {
        float halves = min(bow(p, vec2(0.0, 0.26), vec2(0.24), 0.24), bow(p, vec2(0.0, -0.24), vec2(0.27, 0.26), 0.26));
        return min(halves, min(stroke(p, vec2(-0.2, 0.5), vec2(0.0, 0.5)), stroke(p, vec2(-0.22, -0.5), vec2(0.0, -0.5))));
    }
    if (digit == 4) {
        float legs = min(stroke(p, vec2(0.12, -0.5), vec2(0.12, 0.5)), stroke(p, vec2(0.12, 0.5), vec2(-0.3, -0.2)));
        return min(legs, stroke(p, vec2(-0.3, -0.2), vec2(0.3, -0.2)));
    }
    if (digit == 5) {
        float top = min(stroke(p, vec2(0.24, 0.5), vec2(-0.2, 0.5)), stroke(p, vec2(-0.2, 0.5), vec2(-0.22, 0.12)));
        float belly = min(bow(p, vec2(-0.02, -0.19), vec2(0.29, 0.31), 0.29), stroke(p, vec2(-0.02, -0.5), vec2(-0.24, -0.5)));
        return min(min(top, belly), stroke(p, vec2(-0.22, 0.12), vec2(-0.02, 0.12)));
    }
    if (digit == 6) return min(ring(p, vec2(0.0, -0.22), vec2(0.27, 0.28), 0.27), stroke(p, vec2(-0.25, -0.12), vec2(0.12, 0.5)));
    if (digit == 7) return min(stroke(p, vec2(-0.27, 0.5), vec2(0.27, 0.5)), stroke(p, vec2(0.27, 0.5), vec2(-0.1, -0.5)));
    return min(ring(p, vec2(0.0, 0.26), vec2(0.23, 0.24), 0.23), ring(p, vec2(0.0, -0.24), vec2(0.27, 0.26), 0.26));
}

float number_distance(vec2 p, int number) {
    if (number < 10)
        return digit_distance(p, number);
    return min(digit_distance(p + vec2(0.4, 0.0), number / 10), digit_distance(p - vec2(0.4, 0.0), number % 10));
}
