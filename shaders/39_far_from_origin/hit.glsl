// The payload of this chapter's rays: what a hit shader reports.
#include "common/hit.glsl"

struct PieceHit {
    Hit hit;
    vec3 object;      // in the mesh's space, for a view: the normal, or the ray's origin
    uint place;       // the instance's place in the array that was built: gl_InstanceID
};                    // 84 bytes
