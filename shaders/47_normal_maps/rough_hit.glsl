// The report of a hit shader on a surface that may have microfacets and a normal map.
#include "common/hit.glsl"

struct RoughHit {
    Hit hit;
    float roughness;    // textures already read; -1 for a surface without microfacets
    float metallic;
    vec2 slope;         // of the mapped normal against the normal: x and y over z, in the frame of the normal
};                      // 84 bytes
