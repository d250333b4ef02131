// The queries of the laboratory, their results, and the method that is compiled in.

struct Query {
    vec3 origin;
    float tmin;
    vec3 direction;
    float tmax;
    uint first;   // of the shape's numbers
    uint count;   // how many there are
    uint shape;   // which shape of the acceleration structure is asked
};

struct Answer {
    uint offered;   // whether the device called the intersection at all
    uint hit;
    float t;
    vec3 normal;
    vec3 point;     // of a secondary origin: where the next ray starts
    uint count;     // of a cone, a quadric, a patch, a voxel or an algebraic surface: how often the ray meets it; of a heightfield: how often its height was asked
};

layout(buffer_reference, scalar) readonly buffer Numbers { float at[]; };
layout(buffer_reference, scalar) readonly buffer Queries { Query at[]; };
// Raygen and intersection shader of one ray write to the same answer: for both to see it in order, it has to
// be coherent. For that `shadercallcoherent` is meant, but it counts in another memory model alone.
layout(buffer_reference, scalar) coherent buffer Answers { Answer at[]; };

#ifndef VIEW
layout(push_constant, scalar) uniform Push {
    Queries queries;
    Answers answers;
    Numbers numbers;
    uint count;
    uint asked;    // how often one is asked: count, or where time is measured a multiple of it
    uint repeat;   // how many an invocation answers; 1 unless time is measured
    uint from;     // of a sum: which samples this dispatch adds, from the first until before the last
    uint until;
    float never;   // a t that no ray has
} push;
#endif

// The primitive of the query. The host defines PRIMITIVE; by itself, a shader of this folder is for spheres.
#define PRIMITIVE_SPHERE 0
#define PRIMITIVE_BOX 1
#define PRIMITIVE_PLANE 2
#define PRIMITIVE_TRIANGLE 3
#define PRIMITIVE_CAPSULE 4
#define PRIMITIVE_INSTANCE 5
#define PRIMITIVE_HEIGHTFIELD 6
#define PRIMITIVE_SECONDARY_ORIGIN 7
#define PRIMITIVE_ACCUMULATION 8
#define PRIMITIVE_CONE 9
#define PRIMITIVE_QUADRIC 10
#define PRIMITIVE_PATCH 11
#define PRIMITIVE_VOXEL 12
#define PRIMITIVE_ALGEBRAIC 13
#ifndef PRIMITIVE
#define PRIMITIVE PRIMITIVE_SPHERE
#endif

layout(constant_id = 0) const uint RUNG = 0;
// 1 if fma() rounds once on this device: the host has probed it.
layout(constant_id = 1) const uint FMA_ROUNDS_ONCE = 0;
#define FUSED FMA_ROUNDS_ONCE
