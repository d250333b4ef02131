// Where an instance stands. A ray query is told by the top level; the rasteriser knows no top level.
struct Placed {
    mat4x3 to_world;
    mat4x3 to_object;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Placements { Placed at[]; };
