// The path of a particle during one step, in closed form: a constant acceleration and linear drag.
// With v' = a - c v:  v(t) = v0 (1 - c t E) + a t E  and  x(t) = x0 + t (E v0 + t F a),
// where E = (1 - exp(-c t)) / (c t) and F = (1 - E) / (c t).
// vec2 damping(float ct): E and F.

vec2 damping(float ct) {
    if (ct < 0.1)       // their series, where the formulas would lose digits
        return vec2(1.0 - ct * (1.0 / 2.0 - ct * (1.0 / 6.0 - ct * (1.0 / 24.0 - ct / 120.0))),
                    1.0 / 2.0 - ct * (1.0 / 6.0 - ct * (1.0 / 24.0 - ct * (1.0 / 120.0 - ct / 720.0))));
    float e = (1.0 - exp(-ct)) / ct;
    return vec2(e, (1.0 - e) / ct);
}
