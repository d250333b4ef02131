// Taught by 08_intersection.
//
// The payload of rays that meet shapes: what a hit shader reports. A sphere's or a box's `triangle` is its number.
#include "hit.glsl"

struct ShapeHit {
    Hit hit;
    uint kind;        // a triangle, KIND_SPHERE or KIND_BOX: gl_HitKindEXT
};                    // 72 bytes
