// The random numbers of a pixel.
#include "common/random.glsl"

// The purposes of numbers.
const uint PURPOSE_PIXEL = 0;
const uint PURPOSE_CANDIDATE = 1;
const uint PURPOSE_TIME = 2;
const uint PURPOSE_NEIGHBOUR = 3;
const uint PURPOSE_SPACE = 4;

// Four random numbers of 32 bits.
uvec4 random_bits(uvec2 pixel, uint sample_index, uint purpose, uint i, uint seed) {
    return hash(uvec4(pixel.x | pixel.y << 16u, sample_index, purpose | i << 8u, seed));
}

// A number inside (0, 1), never at an end: a weight that is 0 in 32-bit floats next to the sum must not be kept.
float inside_unit(uint bits) {
    return (float(bits >> 9u) + 0.5) / 8388608.0;
}

// ANCHOR: keep
// Adds a weight to a sum. True if its sample replaces the one kept so far, as often as the weight is part of the sum.
bool replaces(inout float sum, float weight, uint bits) {
    if (!(weight > 0.0)) {
        return false;
    }
    sum += weight;
    return inside_unit(bits) * sum < weight;
}
// ANCHOR_END: keep
