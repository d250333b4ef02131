// Taught by 31_history_and_filter.
//
// The reasons not to use a pixel of the last frame.
#include "common/seen.glsl"

// The tests that are made.
struct Tests {
    bool instance;
    bool plane;
    bool normal;
};

const uint KEPT = 0;
const uint OUTSIDE = 1;       // outside the picture
const uint OTHER = 2;         // another instance
const uint OFF_PLANE = 3;
const uint TURNED = 4;        // another normal
const uint REASONS = 5;

// ANCHOR: same
// Why the last frame's pixel `tap` does not show the surface `here`, whose position and normal are those it had then.
// `reach` is the footprint of either. If both lie on one triangle, or on two that share an edge and its normals:
//
// - A triangle and its corners' normals form an angle whose sine is at most `bend`. From the normal of one point to
//   the shared edge's, the other triangle's and the other point's, there are four such angles.
// - Of the way between the points, one part lies in the first triangle, tilted against the normal by one such
//   angle, the other in the second triangle, tilted by three. To first order no part is longer than its footprint.
uint reason(Seen here, vec3 normal, Seen tap, vec2 reach, float rounding, Tests tests) {
    if (tests.instance && instance_of(tap) != instance_of(here) || instance_of(tap) == NOTHING) {
        return OTHER;
    }
    vec2 bends = vec2(bend_of(here), bend_of(tap));
    vec3 between = tap.position - here.position;
    float tilted = reach.x * bends.x + reach.y * (2.0 * bends.x + bends.y);
    float bound = tilted + (reach.x + reach.y) * PACKING + rounding;
    if (tests.plane && abs(dot(normal, between)) > bound) {
        return OFF_PLANE;
    }
    float apart = length(unpacked(tap.normal) - normal);
    if (tests.normal && apart > 2.0 * (bends.x + bends.y) + 2.0 * PACKING) {
        return TURNED;
    }
    return KEPT;
}
// ANCHOR_END: same
