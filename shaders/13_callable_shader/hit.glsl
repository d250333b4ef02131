// The payload of this chapter's rays: what a hit shader reports.
#include "common/hit.glsl"

struct PatternHit {
    Hit hit;
    vec3 object;      // the position in the mesh's own space, where patterns are
    float weight;     // of the second colour of the material's pattern
};                    // 84 bytes
