"""Small GLSL functions for what the language lacks or leaves undefined; NAME stands for their name."""

from __future__ import annotations

HELPERS = {
    # GLSL leaves pow undefined for a negative base, and for a zero base unless the exponent is positive.
    "power": """\
float NAME(float base, float exponent) {
    const float infinity = uintBitsToFloat(0x7f800000u);
    const float not_a_number = uintBitsToFloat(0x7fc00000u);
    if (exponent == 0.0) return 1.0;
    if (base == 0.0) return exponent > 0.0 ? 0.0 : infinity;
    if (base > 0.0) return pow(base, exponent);
    if (floor(exponent) != exponent) return not_a_number;
    return mod(exponent, 2.0) == 0.0 ? pow(-base, exponent) : -pow(-base, exponent);
}
""",
    "cbrt": """\
float NAME(float value) {
    return value == 0.0 ? 0.0 : sign(value) * pow(abs(value), 1.0 / 3.0);
}
""",
    # Some drivers divide exp by exp, which overflows; beyond 10 the result is 1 in any case.
    "tanh": """\
float NAME(float value) {
    return tanh(clamp(value, -10.0, 10.0));
}
""",
    # The built-in is undefined at the origin.
    "atan2": """\
float NAME(float y, float x) {
    if (x == 0.0 && y == 0.0) return 0.0;
    return atan(y, x);
}
""",
    # The built-in is undefined unless low < high.
    "smoothstep": """\
float NAME(float low, float high, float value) {
    float t = clamp((value - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}
""",
}

# What divides by the number 0 has values too, or none, as in NumPy; compilers take such a quotient as they please.
BY_ZERO = {
    "divide": """\
float NAME(float value) {
    if (value == 0.0 || value != value) return uintBitsToFloat(0x7fc00000u);
    return uintBitsToFloat(value > 0.0 ? 0x7f800000u : 0xff800000u);
}
""",
    "mod": """\
float NAME(float value) {
    return uintBitsToFloat(0x7fc00000u);
}
""",
}


def power_helper(exponent: int) -> str:
    """A function that multiplies its argument out, squaring it as often as ``exponent`` has bits."""
    lines = []
    factors = []
    square = 1
    while square <= exponent:
        name = f"x{square}" if square > 1 else "x"
        if square > 1:
            half = f"x{square // 2}" if square > 2 else "x"
            lines.append(f"    float {name} = {half} * {half};\n")
        if exponent & square:
            factors.append(name)
        square *= 2
    return f"float NAME(float x) {{\n{''.join(lines)}    return {' * '.join(factors)};\n}}\n"
