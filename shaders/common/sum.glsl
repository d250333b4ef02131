// Of no chapter: the sums of --samples. Fixed-point as in 24_accuracy, with 128 bits, and room for negative colours.
//
// A sum is a whole number of 2^-64: four words, the lowest first, negative as two's complement. Sums of
// whole numbers do not round. So the order in which samples are added, and by which program, changes nothing.

// No colour that can be added is as large: 2^31, as a float's exponent. Infinities and NaN are above it.
const uint TOO_LARGE = 127 + 31;

// True if a colour can be added: it is finite.
bool is_addable(float value) {
    return (floatBitsToUint(value) >> 23 & 0xffu) < TOO_LARGE;
}

// Adds a float by its bits: nothing is computed in floats, and only what is below 2^-64 is rounded.
void add_to_sum(inout uvec4 sum, float value) {
    uint bits = floatBitsToUint(value);
    uint exponent = max(bits >> 23 & 0xffu, 1u);
    uint digits = bits & 0x7fffffu | (bits << 1 >= 1u << 24 ? 1u << 23 : 0u);
    // The value is digits * 2^(exponent - 150), or so many units times 2^place.
    int place = int(exponent) - 150 + 64;
    uvec4 units = uvec4(0);
    if (place < 0) {
        uint below = min(uint(-place), 31u);
        units.x = (digits + (1u << (below - 1))) >> below;
    } else {
        uint low;
        uint high;
        umulExtended(digits, 1u << (uint(place) & 31u), high, low);
        uint word = uint(place) >> 5;
        units.x = word == 0 ? low : 0;
        units.y = word == 0 ? high : word == 1 ? low : 0;
        units.z = word == 1 ? high : word == 2 ? low : 0;
        units.w = word == 2 ? high : 0;
    }
    // Minus x is the complement of x and one more.
    bool is_negative = bits >> 31 == 1;
    units = is_negative ? ~units : units;
    uint carry = is_negative ? 1 : 0;
    for (int i = 0; i < 4; i++) {
        uint first;
        uint second;
        sum[i] = uaddCarry(uaddCarry(sum[i], units[i], first), carry, second);
        carry = first + second;
    }
}
