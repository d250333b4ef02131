#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "sort.glsl"

// The third part: each key goes behind all of a lower digit, and behind those of its own that come before it.

// The number of rows of keys sorted at a time: more of them wait less for each other, and take more memory.
const uint ROWS = 2;
shared uint next[DIGITS];         // where the next key of each digit goes
shared uint who[DIGITS][ROWS];    // which invocations have a key of each digit in each row, a bit for each
shared uint sums[WIDTH];

// Where this share's first key of each digit goes: an invocation adds up the digits of its own, and then what the
// invocations before it have.
void begin() {
    const uint EACH = DIGITS / WIDTH;
    const uint first = gl_LocalInvocationIndex * EACH;
    uint sum = 0;
    for (uint d = first; d < first + EACH; d++) {
        next[d] = sum + push.counts.at[gl_WorkGroupID.x * DIGITS + d];
        sum += push.totals.at[d];
        who[d] = uint[ROWS](0, 0);
    }
    sums[gl_LocalInvocationIndex] = sum;
    barrier();
    uint lower = 0;
    for (uint other = 0; other < gl_LocalInvocationIndex; other++) {
        lower += sums[other];
    }
    for (uint d = first; d < first + EACH; d++) {
        next[d] += lower;
    }
    barrier();
}

// Invocations work in no order, and keys of one digit must stay in theirs. So each sets a bit; and how many bits
// there are before its own is how many such keys come before it.
void main() {
    const uint self = gl_LocalInvocationIndex, bit = 1u << self;
    begin();
    for (uint i = share_begin(); i < share_end(); i += ROWS * WIDTH) {
        uint key[ROWS], before[ROWS], all[ROWS];
        bool has_key[ROWS];
        for (uint row = 0; row < ROWS; row++) {
            uint at = i + row * WIDTH + self;
            has_key[row] = at < share_end();
            key[row] = has_key[row] ? push.keys.at[at] : 0;
            if (has_key[row]) {
                atomicOr(who[digit(key[row])][row], bit);
            }
        }
        barrier();
        for (uint row = 0; row < ROWS; row++) {
            uint d = digit(key[row]);
            before[row] = bitCount(who[d][row] & bit - 1);
            all[row] = 0;
            for (uint other = 0; other < ROWS; other++) {
                before[row] += other < row ? bitCount(who[d][other]) : 0;
                all[row] += bitCount(who[d][other]);
            }
            if (has_key[row]) {
                uint place = next[d] + before[row];
                push.sorted_keys.at[place] = key[row];
                push.sorted_values.at[place] = push.values.at[i + row * WIDTH + self];
            }
        }
        barrier();
        // The last of each digit tidies up for all of them.
        for (uint row = 0; row < ROWS; row++) {
            if (has_key[row] && before[row] + 1 == all[row]) {
                next[digit(key[row])] += all[row];
                who[digit(key[row])] = uint[ROWS](0, 0);
            }
        }
        barrier();
    }
}
