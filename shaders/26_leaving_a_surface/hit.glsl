// The payload of this chapter's rays: what a hit shader reports.
#include "common/hit.glsl"

struct TriangleHit {
    Hit hit;
    vec2 barycentrics;
    mat4x3 to_mesh;   // from the world to the mesh's space: gl_WorldToObjectEXT
};                    // 124 bytes
