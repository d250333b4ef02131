// The push constants and the specialization constants of this chapter's shaders.
#include "common/camera.glsl"
#include "common/scene.glsl"
#include "common/shade.glsl"
#include "common/pixel_sum.glsl"

struct MicrofacetRecord {
    float roughness;          // -1 for a material without microfacets
    float metallic;
    int roughness_texture;    // -1 for none
    int metallic_texture;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MicrofacetRecords {
    MicrofacetRecord at[];    // of each material
};

// The sums over all directions of light are kept as differences from a mirror, which loses nothing.
struct Albedo {
    float lost;    // the part of the light lost between facets that reflect everything
    float more;    // what Schlick's fifth power adds to the reflection, above that of a mirror
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Albedos { Albedo at[]; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer RoughAddresses {
    MicrofacetRecords microfacets;
    Albedos albedos;
    Albedos means;            // over all angles, for each roughness
};

// ANCHOR: texel
struct Texel {
    vec3 radiance;
    float density;        // of shadow rays in its directions, by solid angle
};

// A column of the table that chooses texels (29).
struct Column {
    float own;            // the part of the column that belongs to its own number
    uint other;           // the number that owns the rest
};

struct Row {
    float top;            // the cosine of the angle from straight up, at the upper edge
    float height;         // by how much it is smaller at the lower edge
};
// ANCHOR_END: texel

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Texels { Texel at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Columns { Column at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Rows { Row at[]; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer SkyAddresses {
    Texels texels;
    Columns columns;
    Rows rows;
    uvec2 size;           // width and height of the picture
    uint column_count;    // a power of two, or 0 for a black sky
};

layout(push_constant, scalar) uniform Push {
    CameraBasis camera;
    SceneAddresses scene;
    RoughAddresses rough;
    SkyAddresses sky;
    Sums sums;
    float rotation;       // of the sky around the vertical, in turns
    uint depth;           // how often a path may be reflected
    float most;           // what a hit or the sky may add after the first ray; 0 for whatever it brings
    uint seed;
    uint sample_index;    // which of a pixel's samples
} push;

// The specialization constants: the compiler drops code that they rule out.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_RAYS = 1;

layout(constant_id = 1) const uint SAMPLER = 0;
const uint SAMPLER_BOUNCES = 0;
const uint SAMPLER_UNIFORM = 1;
const uint SAMPLER_MAP = 2;
const uint SAMPLER_BOTH = 3;

// The camera and a mirror leave no choice: no shadow ray could have gone there.
const float NO_OTHER = -1.0;

// The purpose of numbers that earlier chapters do not have.
const uint DIMENSION_POINT = 5;

// The best of 45's choices.
const uint SAMPLING = 2;
const uint SAMPLING_DISTRIBUTION = 0;
const uint SAMPLING_BOUNDED = 2;
const uint FORM = 1;
const uint FORM_TEXTBOOK = 0;
const bool COMPENSATION = true;
