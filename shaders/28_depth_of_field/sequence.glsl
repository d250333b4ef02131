// Points of the unit square, one a frame and purpose: places in the pixel, and places on the lens.
#include "common/sequence.glsl"

// What else than in chapters before a number is for.
const uint DIMENSION_LENS = 5;

// ANCHOR: sample
// Where the ray of a frame goes through its pixel, or through the lens, in [0, 1)^2.
vec2 sample_point(uvec2 pixel, uint i, uint dimension) {
    uvec4 key = hash(uvec4(pixel, push.seed, dimension));
    // On the lens the points come in an order of its own. Otherwise a place in the pixel would always go
    // with the same place on the lens.
    uvec2 point = sobol(dimension == DIMENSION_LENS ? owen(i, key.z) : i);
    return vec2(to_unit(owen(point.x, key.x)), to_unit(owen(point.y, key.y)));
}
// ANCHOR_END: sample
