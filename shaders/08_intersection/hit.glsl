// The payload of this chapter's rays: what a hit shader reports.
// A sphere's or a box's `triangle` is its number.
#include "common/hit.glsl"

struct ShapeHit {
    Hit hit;
    uint kind;        // a triangle, KIND_SPHERE or KIND_BOX: gl_HitKindEXT
};                    // 72 bytes
