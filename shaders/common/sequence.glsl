// Taught by 04_jitter_camera; what 11 has of it: Sobol's points, and Owen's scrambling of them.
//
// Coordinates are whole numbers of 2^-32.
#include "common/random.glsl"

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

// Flips each binary digit or not, by a hash of the digits before it (Burley 2020, after Laine and
// Karras 2011).
uint owen(uint x, uint key) {
    x = bitfieldReverse(x) + bitfieldReverse(key);
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return bitfieldReverse(x);
}
