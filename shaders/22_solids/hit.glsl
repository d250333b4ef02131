// The payload of this chapter's rays: what a hit shader reports.
// A solid's `triangle` is its face.
#include "common/hit.glsl"

struct SolidHit {
    Hit hit;
    uint kind;        // a triangle, KIND_ENTERS or KIND_LEAVES: gl_HitKindEXT
};                    // 72 bytes
