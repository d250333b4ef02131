// Taught by 46_environment.
//
// The data of a picture of the sky: its texels, its rows, and the table that chooses a texel.
#include "alias.glsl"

// ANCHOR: texel
struct Texel {
    vec3 radiance;
    float density;        // of shadow rays in its directions, by solid angle
};

struct SkyRow {
    float top;            // the cosine of the angle from straight up, at the upper edge
    float height;         // by how much it is smaller at the lower edge
};
// ANCHOR_END: texel

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Texels { Texel at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SkyRows { SkyRow at[]; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer SkyAddresses {
    Texels texels;
    Columns columns;
    SkyRows rows;
    uvec2 size;           // width and height of the picture
    uint column_count;    // a power of two, or 0 for a black sky
};
