// Rough metal: a path goes on by a facet, as from a mirror, or is scattered by the rest (chapter 45).

// The best of 45's choices.
const uint SAMPLING = 2;
const uint SAMPLING_DISTRIBUTION = 0;
const uint SAMPLING_BOUNDED = 2;
const uint FORM = 1;
const uint FORM_TEXTBOOK = 0;
const bool COMPENSATION = true;
#include "common/balance.glsl"

// The microfacets of a hit, without its colour; with a roughness below 0 if it has none.
MicrofacetRecord microfacet_of(Hit hit) {
    MicrofacetRecord record;
    record.roughness = -1.0;
    if (hit.material < push.world.rough_count) {
        record = push.rough.microfacets.at[hit.material];
#ifdef ROUGH_TEXTURES
        // A packed 1 is not exactly 1, so without a texture nothing is multiplied.
        vec2 texels = vec2(hit.rough & 0xffffu, hit.rough >> 16) / 65535.0;
        record.roughness *= record.roughness_texture < 0 ? 1.0 : texels.x;
        record.metallic *= record.metallic_texture < 0 ? 1.0 : texels.y;
#endif
    }
    return record;
}

// Leaves a path the ways for which it has rays left: to be mirrored by a facet, to be scattered by the rest.
// Returns the part of the light that no ray brings; `continues` is 0 if there is no way left, and else 1.
vec3 with_ways_left(Path path, inout Microfacets surface, out float continues) {
    uint reflected = path.bounce;
    bool scatters = false;
#ifdef EFFECT_BOUNCES
    reflected -= path.bounces;
    scatters = path.bounces < push.world.bounces;
#endif
    bool mirrors = reflected < push.world.depth;
    vec3 lost = (mirrors ? vec3(0.0) : by_facets(surface)) + (scatters ? vec3(0.0) : by_rest(surface));
    if (!mirrors || !scatters) {
        surface.polished = mirrors ? 1.0 : 0.0;
    }
    continues = mirrors || scatters ? 1.0 : 0.0;
    return lost;
}

// The light of a lamp that a surface sends to the eye, as `lit_by`.
vec3 lit_by(Light light, Hit hit, Microfacets surface, float visible) {
    vec3 to_light = normalize(towards_light(light, hit.position));
    return visible * arriving_light(light, hit.position)
        * hit.color * reflected_from(surface, to_light * frame_of(hit.normal));
}
