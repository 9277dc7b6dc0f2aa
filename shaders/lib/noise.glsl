// Perlin noise and turbulence, with gradients and second derivatives.
//
//     float value    = perlin_noise(p);                  // -1.04 to 1.04, 0 at all integer points
//     vec4  slope    = perlin_noise_gradient(p);         // xyz: gradient, w: value
//     mat3  bend     = perlin_noise_hessian(p);          // second derivatives
//     float any      = perlin_noise_derivative(p, ivec3(2, 1, 0));
//
// and the same four for perlin_turbulence. Noise is Ken Perlin, "Improving Noise", SIGGRAPH 2002, with his
// permutation; turbulence is Ken Perlin, "An Image Synthesizer", SIGGRAPH 1985, with 6 octaves.
// viewer/kit/noise.py computes the same on the CPU.

const int PERLIN_OCTAVES = 6;

// Perlin's permutation of 0..255. A constant array is as fast as a uniform block on Mesa's llvmpipe, needs no
// binding, and beats the same table packed four to a word (up to 2.1 times) or in a texture (2 times).
const int PERLIN_PERMUTATION[256] = int[256](
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30,
    69, 142, 8, 99, 37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62,
    94, 252, 219, 203, 117, 35, 11, 32, 57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136,
    171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83, 111, 229, 122,
    60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161,
    1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86,
    164, 100, 109, 198, 173, 186, 3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126,
    255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213,
    119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253,
    19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193,
    238, 210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31,
    181, 199, 106, 157, 184, 84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93,
    222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78, 66, 215, 61, 156, 180
);

int perlin_permuted(int index) {
    return PERLIN_PERMUTATION[index & 255];
}

// The gradient of a lattice point: one of the 12 directions from the centre of a cube to its edges.
vec3 perlin_direction(ivec3 lattice_point) {
    int hash = perlin_permuted(perlin_permuted(perlin_permuted(lattice_point.x) + lattice_point.y) + lattice_point.z);
    float first = (hash & 1) == 0 ? 1.0 : -1.0;
    float second = (hash & 2) == 0 ? 1.0 : -1.0;
    int choice = hash & 15;
    if (choice < 4 || choice == 12 || choice == 14) {
        return choice < 8 ? vec3(first, second, 0.0) : vec3(second, first, 0.0);
    }
    return choice < 8 ? vec3(first, 0.0, second) : vec3(0.0, first, second);
}

// How much the upper of two lattice points weighs, 6t^5 - 15t^4 + 10t^3, and its first two derivatives.
vec3 perlin_fade(vec3 t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }
vec3 perlin_fade_slope(vec3 t) { return 30.0 * t * t * (t * (t - 2.0) + 1.0); }
vec3 perlin_fade_bend(vec3 t) { return 60.0 * t * (t * (2.0 * t - 3.0) + 1.0); }

// Corner 0..7 of a cell: its bits are the steps in x, y and z.
ivec3 perlin_corner(int number) { return ivec3(number & 1, (number >> 1) & 1, number >> 2); }

float perlin_noise(vec3 p) {
    vec3 cell = floor(p);
    vec3 inside = p - cell;
    vec3 fade = perlin_fade(inside);
    float value = 0.0;
    for (int number = 0; number < 8; number++) {
        ivec3 corner = perlin_corner(number);
        vec3 upper = vec3(corner);
        vec3 weight = mix(1.0 - fade, fade, upper);
        vec3 direction = perlin_direction(ivec3(cell) + corner);
        value += weight.x * weight.y * weight.z * dot(direction, inside - upper);
    }
    return value;
}

vec4 perlin_noise_gradient(vec3 p) {
    vec3 cell = floor(p);
    vec3 inside = p - cell;
    vec3 fade = perlin_fade(inside);
    vec3 fade_slope = perlin_fade_slope(inside);
    vec4 result = vec4(0.0);
    for (int number = 0; number < 8; number++) {
        ivec3 corner = perlin_corner(number);
        vec3 upper = vec3(corner);
        vec3 weight = mix(1.0 - fade, fade, upper);
        vec3 slope = mix(-fade_slope, fade_slope, upper);
        vec3 direction = perlin_direction(ivec3(cell) + corner);
        // The product rule: either a weight changes, or the height of the corner's plane above the point.
        vec3 weight_slope = slope * weight.yzx * weight.zxy;
        float height = dot(direction, inside - upper);
        float product = weight.x * weight.y * weight.z;
        result += vec4(weight_slope * height + product * direction, product * height);
    }
    return result;
}

mat3 perlin_noise_hessian(vec3 p) {
    vec3 cell = floor(p);
    vec3 inside = p - cell;
    vec3 fade = perlin_fade(inside);
    vec3 fade_slope = perlin_fade_slope(inside);
    vec3 fade_bend = perlin_fade_bend(inside);
    mat3 result = mat3(0.0);
    for (int number = 0; number < 8; number++) {
        ivec3 corner = perlin_corner(number);
        vec3 upper = vec3(corner);
        vec3 weight = mix(1.0 - fade, fade, upper);
        vec3 slope = mix(-fade_slope, fade_slope, upper);
        vec3 bend = mix(-fade_bend, fade_bend, upper);
        vec3 direction = perlin_direction(ivec3(cell) + corner);
        vec3 weight_slope = slope * weight.yzx * weight.zxy;
        vec3 twice = bend * weight.yzx * weight.zxy;        // xx, yy, zz
        vec3 mixed = weight * slope.yzx * slope.zxy;        // yz, zx, xy
        mat3 weight_bend = mat3(twice.x, mixed.z, mixed.y, mixed.z, twice.y, mixed.x, mixed.y, mixed.x, twice.z);
        result += weight_bend * dot(direction, inside - upper);
        result += outerProduct(weight_slope, direction) + outerProduct(direction, weight_slope);
    }
    return result;
}

// The weights of the lower (x) and the upper (y) lattice point along an axis, differentiated order times.
vec2 perlin_weights(float t, int order) {
    float coefficients[6] = float[6](0.0, 0.0, 0.0, 10.0, -15.0, 6.0);
    float upper = 0.0;
    for (int power = 5; power >= order; power--) {
        float factor = coefficients[power];
        for (int step = 0; step < order; step++) factor *= float(power - step);
        upper = upper * t + factor;
    }
    return vec2((order == 0 ? 1.0 : 0.0) - upper, upper);
}

// Any partial derivative, order.x times in x and so on. Slower than the functions above: for third and higher.
float perlin_noise_derivative(vec3 p, ivec3 order) {
    vec3 cell = floor(p);
    vec3 inside = p - cell;
    vec2 weights[3];
    vec2 lowered[3];
    for (int axis = 0; axis < 3; axis++) {
        weights[axis] = perlin_weights(inside[axis], order[axis]);
        lowered[axis] = order[axis] > 0 ? perlin_weights(inside[axis], order[axis] - 1) : vec2(0.0);
    }
    float value = 0.0;
    for (int number = 0; number < 8; number++) {
        ivec3 corner = perlin_corner(number);
        vec3 weight = vec3(weights[0][corner.x], weights[1][corner.y], weights[2][corner.z]);
        vec3 lower = vec3(lowered[0][corner.x], lowered[1][corner.y], lowered[2][corner.z]);
        vec3 direction = perlin_direction(ivec3(cell) + corner);
        value += weight.x * weight.y * weight.z * dot(direction, inside - vec3(corner));
        value += dot(vec3(order) * lower * weight.yzx * weight.zxy, direction);
    }
    return value;
}

// Octave i adds |noise(2^i p)| / 2^i; each differentiation brings a factor 2^i, and |n| the sign of n.
float perlin_turbulence(vec3 p) {
    float value = 0.0;
    float scale = 1.0;
    for (int octave = 0; octave < PERLIN_OCTAVES; octave++) {
        value += abs(perlin_noise(p * scale)) / scale;
        scale *= 2.0;
    }
    return value;
}

vec4 perlin_turbulence_gradient(vec3 p) {
    vec4 result = vec4(0.0);
    float scale = 1.0;
    for (int octave = 0; octave < PERLIN_OCTAVES; octave++) {
        vec4 noise = perlin_noise_gradient(p * scale);
        result += sign(noise.w) * vec4(noise.xyz, noise.w / scale);
        scale *= 2.0;
    }
    return result;
}

mat3 perlin_turbulence_hessian(vec3 p) {
    mat3 result = mat3(0.0);
    float scale = 1.0;
    for (int octave = 0; octave < PERLIN_OCTAVES; octave++) {
        result += sign(perlin_noise(p * scale)) * scale * perlin_noise_hessian(p * scale);
        scale *= 2.0;
    }
    return result;
}

float perlin_turbulence_derivative(vec3 p, ivec3 order) {
    int depth = order.x + order.y + order.z;
    if (depth == 0) return perlin_turbulence(p);
    float value = 0.0;
    float scale = 1.0;
    for (int octave = 0; octave < PERLIN_OCTAVES; octave++) {
        float growth = pow(scale, float(depth - 1));
        value += sign(perlin_noise(p * scale)) * growth * perlin_noise_derivative(p * scale, order);
        scale *= 2.0;
    }
    return value;
}
