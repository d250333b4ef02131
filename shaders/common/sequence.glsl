// Taught by 37_sequences.
//
// Points of the unit square, one per frame.
//
// Coordinates are whole numbers of 2^-32. They wrap around by themselves, lose no digit however far a
// sequence goes, and have the same bits on every device.
#include "common/random.glsl"

const uint SEQUENCE_CENTRE = 0;
const uint SEQUENCE_RANDOM = 1;
const uint SEQUENCE_HALTON = 2;
const uint SEQUENCE_R2 = 3;
const uint SEQUENCE_SOBOL = 4;

const uint SCRAMBLING_NONE = 0;
const uint SCRAMBLING_ROTATION = 1;
const uint SCRAMBLING_OWEN = 2;

// ANCHOR: halton
// The digits of i in base 3, mirrored at the point: 1 is 0.1, 2 is 0.2, 3 is 0.01.
uint mirrored_base_3(uint i) {
    uint mirrored = 0;
    uint third = 0xffffffffu / 3u;
    for (; i > 0; i /= 3) {
        mirrored += (i % 3) * third;
        third /= 3;
    }
    return mirrored;
}

uvec2 halton(uint i) {
    return uvec2(bitfieldReverse(i), mirrored_base_3(i));
}
// ANCHOR_END: halton

// Multiples of 1/g and 1/g^2, where g = 1.3247... solves g^3 = g + 1. The product drops whole turns.
uvec2 r2(uint i) {
    return i * uvec2(3242174889u, 2447445414u);
}

#include "common/sobol.glsl"
