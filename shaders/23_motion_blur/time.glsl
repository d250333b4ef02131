// The time of a sample, and which instances its rays see.
#include "common/random.glsl"
#include "common/ray_time.glsl"

// The purpose of a random number, beside those of earlier chapters.
const uint DIMENSION_TIME = 2;

// The time of a pixel's sample: 0 when the shutter opens, and less than 1.
float sample_time(uvec2 pixel, uint i) {
    float u = random(pixel, i, push.frame, DIMENSION_TIME).x;
    switch (TIMES) {
        case TIMES_MIDDLE: return 0.5;
        case TIMES_RANDOM: return u;
        // One time in each of as many equal parts of the shutter's time as there are samples.
        default: return min((float(i) + u) / float(push.samples), 0.99999994);
    }
}

// The cull mask of a ray at this time.
uint mask_of(float time) {
    return METHOD == METHOD_MOMENTS ? 1u << uint(time * float(push.moments)) : 0xff;
}
