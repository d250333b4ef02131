// The first hit of a path: the surface whose light is kept from frame to frame.
#include "common/bend.glsl"

// ANCHOR: reflectance
// The part of its light that a surface sends on, about: what is left varies slowly. Any colour would do that is the
// same for all samples.
vec3 reflectance(Hit hit, vec3 direction) {
    MaterialRecord material = push.scene.materials.at[hit.material];
    bool polished = material.illumination >= ILLUMINATION_MIRROR;
    float to_eye = max(dot(hit.normal, -direction), 0.0);
    vec3 mirror = polished ? fresnel(material.specular, to_eye) : material.specular;
    return mirror + hit.color * (1.0 - mirror);
}
// ANCHOR_END: reflectance

// Writes what a pixel sees, and returns the colour that its light is divided by.
vec3 see(uint index, Hit hit, vec3 direction) {
    bool is_sky = hit.t < 0.0;
    vec3 color = is_sky || !DIVIDE ? vec3(1.0) : reflectance(hit, direction);
    Seen surface;
    surface.position = is_sky ? vec3(0.0) : hit.position;
    surface.normal = packed(is_sky ? -direction : hit.normal);
    surface.rest = is_sky ? packed_rest(NOTHING, 1, 0.0)
        : packed_rest(hit.instance, 1, bend(push.scene.instances.at[hit.instance], hit.triangle));
    push.pixels.surfaces.at[index] = surface;
    uint stored = packed_color(color);
    push.pixels.colors.at[index] = stored;
    return unpacked_color(stored);
}
