// Taught by 29_emitters.
//
// The list of a scene's emitters, and of the spheres among them.
#include "common/emitter.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer EmitterAddresses {
    Emitters emitters;    // all spheres, then the triangles of each mesh that shines
    Columns columns;
    Numbers first;        // of each instance: which emitter its triangle 0 is
    Numbers sphere_ids;   // primitive i of the build is sphere sphere_ids.at[i]
    uint count;           // of the emitters
    uint column_count;    // a power of two, or 0 where nothing shines
};
