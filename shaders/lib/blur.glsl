// The weights of a blur over seven taps: the sixth row of Pascal's triangle, close to a Gaussian.
// float blur_weight(int tap): for taps -BLUR_TAPS to BLUR_TAPS; they sum to 1.

const int BLUR_TAPS = 3;

float blur_weight(int tap) {
    int away = abs(tap);
    return away == 0 ? 0.3125 : away == 1 ? 0.234375 : away == 2 ? 0.09375 : 0.015625;
}
