// Rays that are given in a buffer, and answered in another.
#include "tree.glsl"

struct Given {
    vec3 origin;
    float tmax;
    vec3 direction;
    uint any;             // not 0: any hit will do
};

struct Answer {
    float t;
    uint instance;        // of the scene; NOTHING for a miss
    uint position;        // among all corners; of the device's own answers, the primitive
    uint count;           // nodes and triangles that it took; by brute force, triangles that were met
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer AllGiven { Given at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer Answers { Answer at[]; };

layout(push_constant, scalar) uniform Launch {
    AllTrees trees;
    AllGiven given;
    Answers answers;
    uint rays;
    uint across;          // invocations in a row of the launch
    uint instances;
} launch;
