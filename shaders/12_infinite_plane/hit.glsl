// The payload of this chapter's rays: what a hit shader reports.
// The plane is reported by the raygen shader itself.
#include "common/hit.glsl"

struct CurvedHit {
    Hit hit;
    float curvature;  // by how much the normal turns in a unit of length
};                    // 72 bytes

const uint PLANE = -2;   // the plane's `instance`
