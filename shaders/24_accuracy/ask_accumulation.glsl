// The mean of n samples: pattern, value, spike or head, every, n; the last two are integers.
#include "answer.glsl"
#include "common/accumulation.glsl"

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

float mean_by(uint rung, Sequence sequence) {
    float sum = 0.0;
    vec2 kahan = vec2(0.0);
    FixedSum fixed_sum = FixedSum(0, 0);
    // As many bits for the fraction as leave room for the brightest sample, `count` times.
    float brightest = max(sequence.value, sequence.pattern == 0.0 ? 0.0 : sequence.other);
    int bits = 62 - exponent_of(brightest) - exponent_of(float(sequence.count));
    for (uint i = 0; i < sequence.count; i++) {
        float value = sample_of(sequence, i);
        switch (rung) {
            case ACCUMULATE_SUM: add_to_sum(sum, value); break;
            case ACCUMULATE_MEAN: add_to_mean(sum, value, i + 1); break;
            case ACCUMULATE_KAHAN: add_to_kahan(kahan, value); break;
            default: add_to_fixed(fixed_sum, value, bits); break;
        }
    }
    switch (rung) {
        case ACCUMULATE_SUM: return sum / float(sequence.count);
        case ACCUMULATE_MEAN: return sum;
        case ACCUMULATE_KAHAN: return kahan.x / float(sequence.count);
        default: return mean_of_fixed(fixed_sum, bits, sequence.count);
    }
}

Answer ask_accumulation(uint rung, Query query, Numbers numbers) {
    uint first = query.first;
    Sequence sequence = Sequence(
        numbers.at[first], numbers.at[first + 1], numbers.at[first + 2],
        uint(numbers.at[first + 3]), uint(numbers.at[first + 4]));
    Answer answer = NO_HIT;
    answer.t = mean_by(rung, sequence);
    return answer;
}
