#include "common/footprint.glsl"
#include "bent.glsl"

// The payload of a path's rays: cone and beam go in, the hit comes out.
struct Seen {
    Hit hit;
    Cone cone;
    Beam beam;
    float curvature;   // of a surface that sends rays on
};
