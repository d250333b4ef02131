// Taught by 11_path_tracing.
//
// The samples of a pixel, added up without rounding the sum.

// 32 bits before the point and 32 after it, for each colour.
struct PixelSum {
    uvec3 whole;
    uvec3 part;     // in units of 2^-32
    uint count;     // how many samples are in it
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Sums { PixelSum at[]; };

// ANCHOR: add
// A sample is rounded once, to a multiple of 2^-32, and the sum never: it does not depend on the order,
// and sums of some samples each add up to the sum of all.
void add_whole(inout PixelSum sum, vec3 value) {
    // A NaN or a negative value would spoil all samples of the pixel.
    value = clamp(mix(value, vec3(0.0), isnan(value)), 0.0, 65535.0);
    vec3 whole = floor(value);
    uvec3 carry;
    sum.part = uaddCarry(sum.part, uvec3((value - whole) * 4294967296.0), carry);
    sum.whole += uvec3(whole) + carry;
}

vec3 mean_of_whole(PixelSum sum) {
    return (vec3(sum.whole) + vec3(sum.part) / 4294967296.0) / float(sum.count);
}
// ANCHOR_END: add
