#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "sort.glsl"

// The third part: each key goes behind all of a lower digit, and behind those of its own that come before it.

shared uint next[DIGITS];              // where the next key of each digit goes
shared uint sums[WIDTH];
const uint WORDS = WIDTH / 32;
shared uint who[DIGITS][WORDS];        // which invocations have a key of each digit, a bit for each

// ANCHOR: begin
// Where this share's first key of each digit goes.
void begin() {
    const uint self = gl_LocalInvocationIndex;
    const uint EACH = DIGITS / WIDTH;
    uint sum = 0;
    for (uint d = self * EACH; d < (self + 1) * EACH; d++) {
        next[d] = sum;
        sum += push.totals.at[d];
        for (uint word = 0; word < WORDS; word++) {
            who[d][word] = 0;
        }
    }
    sums[self] = sum;
    barrier();
    uint lower = 0;
    for (uint other = 0; other < self; other++) {
        lower += sums[other];
    }
    for (uint d = self * EACH; d < (self + 1) * EACH; d++) {
        next[d] += lower + push.counts.at[gl_WorkGroupID.x * DIGITS + d];
    }
    barrier();
}
// ANCHOR_END: begin

// ANCHOR: scatter
// Invocations work in no order, and keys of one digit must stay in theirs. So each sets a bit; and how many bits
// lie below its own is how many such keys come before it.
void main() {
    const uint self = gl_LocalInvocationIndex;
    begin();
    for (uint i = share_begin(); i < share_end(); i += WIDTH) {
        bool has_key = i + self < share_end();
        uint key = has_key ? push.keys.at[i + self] : 0;
        uint d = digit(key);
        uint bit = 1u << self % 32;
        if (has_key) {
            atomicOr(who[d][self / 32], bit);
        }
        barrier();
        uint before = 0, all = 0;
        for (uint word = 0; word < WORDS; word++) {
            uint bits = who[d][word];
            uint lower = word < self / 32 ? bits : word == self / 32 ? bits & bit - 1 : 0;
            before += bitCount(lower);
            all += bitCount(bits);
        }
        if (has_key) {
            uint place = next[d] + before;
            push.sorted_keys.at[place] = key;
            push.sorted_values.at[place] = push.values.at[i + self];
        }
        barrier();
        // The last of each digit tidies up for all of them.
        if (has_key && before + 1 == all) {
            next[d] += all;
            for (uint word = 0; word < WORDS; word++) {
                who[d][word] = 0;
            }
        }
        barrier();
    }
}
// ANCHOR_END: scatter
