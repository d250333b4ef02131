// The payload of this chapter's rays: what a hit shader reports.
// `offset` is enough for a ray that starts below the surface, too.
#include "common/hit.glsl"

struct BodyHit {
    Hit hit;
    bool entering;    // whether the ray came from outside of the body
};                    // 72 bytes
