// The sum of a pixel by floats, for comparison: `whole` holds their bits.
#include "common/pixel_sum.glsl"

void add_floats(inout PixelSum sum, vec3 value) {
    sum.whole = floatBitsToUint(uintBitsToFloat(sum.whole) + value);
}

vec3 mean_of_floats(PixelSum sum) {
    return uintBitsToFloat(sum.whole) / float(sum.count);
}
