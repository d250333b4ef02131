// Points of the unit square, one a frame and purpose, and what makes them differ from pixel to pixel.
//
// Coordinates are whole numbers of 2^-32. They wrap around by themselves, lose no digit however far a
// sequence goes, and have the same bits on every device.
#include "common/random.glsl"

// What else than in chapters before a number is for.
const uint DIMENSION_LENS = 5;

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

// ANCHOR: r2
// Multiples of 1/g and 1/g^2, where g = 1.3247... solves g^3 = g + 1. The product drops whole turns.
uvec2 r2(uint i) {
    return i * uvec2(3242174889u, 2447445414u);
}
// ANCHOR_END: r2

// ANCHOR: sobol
// The second coordinate adds, without carry, one column of Pascal's triangle modulo 2 for each bit of i.
uvec2 sobol(uint i) {
    uint second = 0;
    uint column = 1u << 31u;
    for (uint bits = i; bits > 0; bits >>= 1) {
        second ^= (bits & 1u) * column;
        column ^= column >> 1;
    }
    return uvec2(bitfieldReverse(i), second);
}
// ANCHOR_END: sobol

// ANCHOR: owen
// Flips each binary digit or not, by a hash of the digits before it (Burley 2020, after Laine and
// Karras 2011). Carries only go upwards, so with the bits reversed a digit depends on those before it;
// and each factor is even, so that none depends on itself. The key is reversed too: its first bits
// decide the first digits, and of a hash the upper bits are the better ones.
uint owen(uint x, uint key) {
    x = bitfieldReverse(x) + bitfieldReverse(key);
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return bitfieldReverse(x);
}
// ANCHOR_END: owen

// ANCHOR: sample
// Where the ray of a frame goes through its pixel, or through the lens, in [0, 1)^2.
vec2 sample_point(uvec2 pixel, uint i, uint dimension) {
    if (push.sequence == SEQUENCE_CENTRE) {
        return vec2(0.5);
    }
    // Random numbers that belong to the pixel, or to all of them.
    uvec2 owner = push.scrambling == SCRAMBLING_NONE ? uvec2(0) : pixel;
    uvec4 key = hash(uvec4(owner, push.seed, dimension));
    // On the lens the points come in an order of its own. Otherwise a place in the pixel would always go
    // with the same place on the lens.
    i = dimension == DIMENSION_LENS ? owen(i, key.z) : i;
    uvec2 point = hash(uvec4(key.zw, i, 0)).xy;
    if (push.sequence == SEQUENCE_HALTON) {
        point = halton(i);
    }
    if (push.sequence == SEQUENCE_R2) {
        point = r2(i);
    }
    if (push.sequence == SEQUENCE_SOBOL) {
        point = sobol(i);
    }
    if (push.scrambling == SCRAMBLING_ROTATION) {
        point += key.xy;
    }
    if (push.scrambling == SCRAMBLING_OWEN) {
        point = uvec2(owen(point.x, key.x), owen(point.y, key.y));
    }
    return vec2(to_unit(point.x), to_unit(point.y));
}
// ANCHOR_END: sample
