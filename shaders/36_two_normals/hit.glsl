// The payload of this chapter's rays: what a hit shader reports.
#include "common/hit.glsl"

struct SmoothHit {
    Hit hit;
    vec3 terminator_offset;    // from the flat triangle to the round surface that its normals pretend
};                             // 80 bytes
