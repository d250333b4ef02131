// Taught by 31_history_and_filter.
//
// The state of a pixel, 92 bytes: two surfaces, two estimates, a colour, and an estimate for the filter.
#include "common/octahedron.glsl"

// ANCHOR: surface
struct Seen {
    vec3 position;    // in the world
    uint normal;      // see unpacked()
    uint rest;        // from the top: instance, 16 bits; length of the history, 8; bend, 8
};                    // 20 bytes; a pixel has two, this frame's and the last one's

struct Estimate {
    vec3 light;       // the mean
    float square;     // the mean of the squared luminance; in the filter, the variance of the mean
};                    // 16 bytes; a pixel has three: history, last frame's history, filter
// ANCHOR_END: surface

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Surfaces { Seen at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Estimates { Estimate at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Colors { uint at[]; };

// Where all of that is.
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer PixelAddresses {
    Surfaces surfaces;
    Estimates estimates;
    Surfaces last_surfaces;      // of the last frame
    Estimates last_estimates;
    Colors colors;
    uvec2 size;                  // of the picture
};

// The instance of a pixel that shows the sky.
const uint NOTHING = 0xffff;

uint instance_of(Seen surface) {
    return surface.rest >> 16;
}

uint length_of(Seen surface) {
    return surface.rest >> 8 & 0xffu;
}

// A bound on the sine of the angle between the triangle and the normals of its corners.
float bend_of(Seen surface) {
    return float(surface.rest & 0xffu) / 255.0;
}

uint packed_rest(uint instance, uint length, float bend) {
    // Less than a thousandth of a unit is rounding, as on a flat surface that is tilted; PACKING has room for it.
    return instance << 16 | length << 8 | uint(ceil(max(255.0 * bend - 1e-3, 0.0)));
}

// Ten bits per channel, and none is 0: light is divided by the colour.
uint packed_color(vec3 color) {
    uvec3 parts = uvec3(round(1023.0 * clamp(color, 1.0 / 1023.0, 1.0)));
    return parts.r | parts.g << 10 | parts.b << 20;
}

vec3 unpacked_color(uint color) {
    return vec3(color & 1023u, color >> 10 & 1023u, color >> 20) / 1023.0;
}

float luminance(vec3 light) {
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}
