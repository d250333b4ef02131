// Where the centres of some triangles lie, and how many of the triangles are finite.
struct Extent {
    vec3 low;
    uint count;
    vec3 high;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Extents { Extent at[]; };
