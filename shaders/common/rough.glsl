// Taught by 45_rough_metal.
//
// The data of rough surfaces: the microfacets of each material, and the table of what microfacets reflect in all.

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
