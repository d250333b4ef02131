// The mean of many samples, one after the other: four ways that are equal on paper.
#include "common/two_float.glsl"

const uint ACCUMULATE_SUM = 0;
const uint ACCUMULATE_MEAN = 1;
const uint ACCUMULATE_KAHAN = 2;
const uint ACCUMULATE_FIXED = 3;

// The sum so far. Once it is 2^24 samples large, a further one is less than half its last place, and
// rounding takes it away.
void add_to_sum(inout float sum, float value) {
    sum += value;
}

// The mean so far, moved towards the sample: `count` with it. Nothing grows, but late steps are small
// beside the mean, and they round.
void add_to_mean(inout float mean, float value, uint count) {
    precise float next = mean + (value - mean) / float(count);
    mean = next;
}

// The sum so far in x; in y what rounding has added to it, which the next sample takes off (Kahan,
// Communications of the ACM 8:1, 1965).
void add_to_kahan(inout vec2 sum, float value) {
    precise float owed = value - sum.y;
    precise float next = sum.x + owed;
    precise float error = (next - sum.x) - owed;
    sum = vec2(next, error);
}

// The sum in 64 bits without a floating point. Each sample is rounded once, whatever came before: the sum
// does not depend on the order, and sums of parts of the samples add up to that of all.
struct FixedSum {
    uint high;
    uint low;
};

// `bits` is how many of the 64 stand for the fraction; the sum must be less than 2^(64 - bits), and no
// sample less than 0.
void add_to_fixed(inout FixedSum sum, float value, int bits) {
    // In units of 2^32: what is whole belongs to `high`, the rest to `low`. Only the last line rounds.
    precise float units = scaled(value, bits - 32);
    precise float whole = floor(units);
    precise float rest = units - whole;
    uint part = uint(roundEven(scaled(rest, 32)));
    uint carry;
    sum.low = uaddCarry(sum.low, part, carry);
    sum.high += uint(whole) + carry;
}

// The sum over `count`, rounded once. A float holds 24 bits, so 16 at a time.
float mean_of_fixed(FixedSum sum, int bits, uint count) {
    vec3 total = vec3(0.0);
    sum_add(total, scaled(float(sum.high >> 16), 48));
    sum_add(total, scaled(float(sum.high & 0xffffu), 32));
    sum_add(total, scaled(float(sum.low >> 16), 16));
    sum_add(total, float(sum.low & 0xffffu));
    vec2 divisor = two_sum(65536.0 * float(count >> 16), float(count & 0xffffu));
    return scaled(ff_div(sum_total(total), divisor), -bits).x;
}
