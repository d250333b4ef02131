// The mean of n samples: pattern, value, spike or head, every, n; of the last two, whole numbers of more
// bits than a float has, the upper and the lower 16 bits.
#include "answer.glsl"
#include "accumulation.glsl"

const float PATTERN_FIREFLY = 1.0;
const float PATTERN_HEAD = 2.0;

struct Sequence {
    float pattern;
    float value;
    float other;   // spike or head
    uint every;
    uint count;
};

float sample_of(Sequence sequence, uint i) {
    bool other = sequence.pattern == PATTERN_FIREFLY ? i % sequence.every == sequence.every - 1
                                                     : sequence.pattern == PATTERN_HEAD && i == 0;
    return other ? sequence.other : sequence.value;
}

// The state of a sum, by any rung.
struct Sums {
    float sum;
    vec2 kahan;
    FixedSum fixed_sum;
};

// As many bits for the fraction as leave room for the brightest sample, `count` times.
int fraction_bits(Sequence sequence) {
    float brightest = max(sequence.value, sequence.pattern == 0.0 ? 0.0 : sequence.other);
    return 62 - exponent_of(brightest) - exponent_of(float(sequence.count));
}

void add_samples(uint rung, Sequence sequence, uint from, uint until, inout Sums sums) {
    int bits = fraction_bits(sequence);
    for (uint i = from; i < min(until, sequence.count); i++) {
        float value = sample_of(sequence, i);
        switch (rung) {
            case ACCUMULATE_SUM: add_to_sum(sums.sum, value); break;
            case ACCUMULATE_MEAN: add_to_mean(sums.sum, value, i + 1); break;
            case ACCUMULATE_KAHAN: add_to_kahan(sums.kahan, value); break;
            default: add_to_fixed(sums.fixed_sum, value, bits); break;
        }
    }
}

float mean_by(uint rung, Sequence sequence, Sums sums) {
    switch (rung) {
        case ACCUMULATE_SUM: return sums.sum / float(sequence.count);
        case ACCUMULATE_MEAN: return sums.sum;
        case ACCUMULATE_KAHAN: return sums.kahan.x / float(sequence.count);
        default: return mean_of_fixed(sums.fixed_sum, fraction_bits(sequence), sequence.count);
    }
}

uint whole_at(Numbers numbers, uint first) {
    return uint(numbers.at[first]) << 16 | uint(numbers.at[first + 1]);
}

// The samples from `from` until before `until`, added to what `before` holds of those before `from`. The
// answer's other fields, which a mean has no use for, carry the sum into the next dispatch.
Answer sum_on(uint rung, Query query, Numbers numbers, uint from, uint until, Answer before) {
    uint first = query.first;
    Sequence sequence = Sequence(
        numbers.at[first], numbers.at[first + 1], numbers.at[first + 2],
        whole_at(numbers, first + 3), whole_at(numbers, first + 5));
    if (from == 0) {
        before = NO_HIT;
    }
    Sums sums = Sums(before.point.x, before.point.yz, FixedSum(before.hit, before.count));
    add_samples(rung, sequence, from, until, sums);
    Answer answer = NO_HIT;
    answer.t = mean_by(rung, sequence, sums);
    answer.point = vec3(sums.sum, sums.kahan);
    answer.hit = sums.fixed_sum.high;
    answer.count = sums.fixed_sum.low;
    return answer;
}

Answer ask_accumulation(uint rung, Query query, Numbers numbers) {
    return sum_on(rung, query, numbers, 0, 0xffffffffu, NO_HIT);
}
