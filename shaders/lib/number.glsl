// Whether a float is a number that one can compute with.
// bool is_finite(float value): neither NaN nor infinite.

// By its bits: compilers may take for granted that no comparison meets a NaN.
bool is_finite(float value) {
    return (floatBitsToInt(value) & 0x7f800000) != 0x7f800000;
}
