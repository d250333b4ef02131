// The state of a pixel, 96 bytes: two receivers, two reservoirs, a colour, and a mean.
#include "common/octahedron.glsl"

// ANCHOR: state
// A place that light arrives at.
struct Receiver {
    vec3 from;        // where shadow rays start
    uint normal;      // to shade with; NOTHING for a pixel without a surface that scatters light
    uint face;        // the triangle's own
};                    // 20 bytes; a pixel has two, this frame's and the last one's

// One sample of many, and how many it speaks for.
struct Reservoir {
    uint emitter;
    uint at;          // which point of the emitter: two numbers of 16 bits
    float weight;     // 1 over the density of this sample, on average; 0 if there is none
    uint count;       // the candidates it was chosen from
};                    // 16 bytes; a pixel has two, a fresh one and the last frame's
// ANCHOR_END: state

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Receivers { Receiver at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Reservoirs { Reservoir at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Colors { vec3 at[]; };

// Where all of that is.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer PixelAddresses {
    Receivers receivers;
    Receivers last_receivers;    // of the last frame
    Reservoirs fresh;
    Reservoirs kept;             // from frame to frame
    Colors colors;
    Colors means;                // of all frames since the last change
    uvec2 size;                  // of the picture
};

// Not a packed normal: each half of one is at least -32767.
const uint NOTHING = 0x80008000u;

const Receiver NO_RECEIVER = Receiver(vec3(0.0), NOTHING, NOTHING);
const Reservoir EMPTY = Reservoir(0, 0, 0.0, 0);
