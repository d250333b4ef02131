// Taught by 37_sequences.
//
// Sobol's points of the unit square, and Owen's scrambling of them: whole numbers of 2^-32.
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
