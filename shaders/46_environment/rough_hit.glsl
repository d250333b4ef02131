// Like rough_hit.glsl in 45_rough_metal, but a miss also reports how likely a shadow ray goes there.
#include "common/hit.glsl"

struct RoughHit {
    Hit hit;
    float roughness;    // textures already read; -1 for a surface without microfacets
    float metallic;
    float density;      // of shadow rays in the direction of a miss
};                      // 80 bytes
