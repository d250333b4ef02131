#include "common/footprint.glsl"
#include "bent.glsl"

// The payload of a path's rays: cone or beam goes in, the hit comes out. The pipeline defines DIFFERENTIALS for the
// footprint that reads the beam: a specialization constant could not leave a field out.
struct Seen {
    Hit hit;
#ifdef DIFFERENTIALS
    Beam beam;
#else
    Cone cone;
#endif
    float curvature;   // of a surface that sends rays on
};                     // 80 bytes; 120 with the beam
