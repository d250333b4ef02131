// The payload of this chapter's rays: what a hit shader reports.
// A strand's `triangle` is the segment, of all strands.
#include "common/hit.glsl"

struct StrandHit {
    Hit hit;
    float along;      // where on a segment: 0 and 1 are its ends; -1 on a triangle
};                    // 72 bytes
