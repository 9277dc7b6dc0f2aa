// A smooth random flow without sources or sinks, from Perlin's noise.
// vec3 curl_noise(vec3 p): its mean square is about 1; eddies are about one unit wide.
//
// The flow is the curl of the vector potential a grad(b), which is grad(a) x grad(b), for two noises a and b
// (Bridson, Houriham and Nordenstam, "Curl-Noise for Procedural Fluid Flow", 2007, for the idea of a potential;
// DeWolf, "Divergence-Free Noise", 2005, for this one, which takes two noises instead of three).
// viewer/kit/curl_noise.py computes the same on the CPU.
#include "lib/noise.glsl"

const vec3 CURL_NOISE_APART = vec3(31.416, -47.853, 12.793);
const float CURL_NOISE_SCALE = 0.814;

vec3 curl_noise(vec3 p) {
    return CURL_NOISE_SCALE * cross(perlin_noise_gradient(p).xyz, perlin_noise_gradient(p + CURL_NOISE_APART).xyz);
}
