// Random numbers that depend on nothing but what they are asked for.
// uint pcg(uint number): one 32-bit number scattered into another, each exactly once
// (Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020).
// float next_random(inout uint state): 0 up to but not 1, and the state moves on.
// float random_of(uint identity, uint channel): the same for a particle's quality number `channel`.

uint pcg(uint number) {
    uint state = number * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

float next_random(inout uint state) {
    state = pcg(state);
    return float(state >> 8u) / 16777216.0;
}

float random_of(uint identity, uint channel) {
    return float(pcg(identity + pcg(channel)) >> 8u) / 16777216.0;
}
