// Makes the points of a sequence differ from pixel to pixel, and from purpose to purpose.
#include "common/sequence.glsl"

// The purpose of a random number, beside those of earlier chapters.
const uint DIMENSION_LENS = 5;

// The place in the pixel or on the lens for the ray of a frame, in [0, 1)^2.
vec2 sample_point(uvec2 pixel, uint i, uint dimension) {
    if (push.sequence == SEQUENCE_CENTRE) {
        return vec2(0.5);
    }
    // Random numbers that belong to the pixel, or to all of them.
    uvec2 owner = push.scrambling == SCRAMBLING_NONE ? uvec2(0) : pixel;
    uvec4 key = hash(uvec4(owner, push.seed, dimension));
    // The lens takes the points in a different order. Otherwise a place in the pixel would always go
    // with the same place on the lens.
    i = dimension == DIMENSION_LENS ? owen(i, key.z) : i;
    uvec2 point = hash(uvec4(key.zw, i, 0)).xy;
    if (push.sequence == SEQUENCE_HALTON) {
        point = halton(i);
    }
    if (push.sequence == SEQUENCE_R2) {
        point = r2(i);
    }
    if (push.sequence == SEQUENCE_SOBOL) {
        point = sobol(i);
    }
    if (push.scrambling == SCRAMBLING_ROTATION) {
        point += key.xy;
    }
    if (push.scrambling == SCRAMBLING_OWEN) {
        point = uvec2(owen(point.x, key.x), owen(point.y, key.y));
    }
    return vec2(to_unit(point.x), to_unit(point.y));
}
