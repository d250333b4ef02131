#include "common/footprint.glsl"

// The payload of the camera's rays: the cone goes in, the hit comes out.
struct Seen {
    Hit hit;
    Cone cone;
};
