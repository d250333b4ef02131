// Taught by 47_normal_maps.
//
// The normal map of each material.

struct NormalMapRecord {
    int number;               // of its texture; -1 for none
    float scale;              // multiplies x and y of its normals
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer NormalMaps {
    NormalMapRecord at[];     // of each material
};
