// A step of a radix sort: by ten bits of the keys, from the lowest to the highest in three steps. Keys that have
// the same ten bits stay in the order that they come in, which is that of the bits below.

// One bit of a word for each invocation.
const uint WIDTH = 32;
layout(local_size_x = WIDTH) in;

const uint DIGITS = 1024;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Words { uint at[]; };

layout(push_constant, scalar) uniform Sort {
    Words keys;
    Words values;
    Words sorted_keys;
    Words sorted_values;
    Words counts;       // of each digit, for each share
    Words totals;       // of each digit
    uint count;
    uint share_length;  // how many keys a workgroup has
    uint shares;
    uint shift;
} push;

uint digit(uint key) {
    return key >> push.shift & (DIGITS - 1);
}

uint share_begin() {
    return gl_WorkGroupID.x * push.share_length;
}

uint share_end() {
    return min(share_begin() + push.share_length, push.count);
}
