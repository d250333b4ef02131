// The report of a hit shader on a surface that may have microfacets.
#include "common/hit.glsl"

struct RoughHit {
    Hit hit;
    float roughness;    // textures already read; -1 for a surface without microfacets
    float metallic;
};                      // 76 bytes
