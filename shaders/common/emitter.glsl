// Taught by 29_emitters.
//
// Emitters: spheres, and triangles of meshes; and the table by which one of them is chosen.
#include "alias.glsl"

struct Emitter {
    vec3 corner;          // a triangle's first; a sphere's centre
    float radius;         // a sphere's; 0 for a triangle
    vec3 across;          // from a triangle's first corner to its second
    float probability;    // that it is chosen by its power
    vec3 along;           // and to its third
    uint material;
    float offset;         // a ray that ends so far above it, and `slack` times its length, does not meet it
    float slack;
};

// Where a shadow ray goes.
struct Aim {
    vec3 direction;    // to a point of the emitter
    float angle;       // the solid angle that the direction stands for: 1 over its density
    vec3 to;           // as far as the ray goes: to just above that point
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Emitters { Emitter at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Numbers { uint at[]; };
