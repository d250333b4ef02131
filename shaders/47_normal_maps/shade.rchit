#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "rough_hit.glsl"
#include "common/frame.glsl"
#include "common/report.glsl"
#include "common/slope.glsl"

layout(location = 0) rayPayloadInEXT RoughHit rough;
hitAttributeEXT vec2 barycentrics;

// Green is roughness and blue is metalness, as in glTF; textures without a curve for the eye.
float texel(int texture_number, vec2 uv, int channel) {
    return texture_number < 0 ? 1.0
        : textureLod(textures[nonuniformEXT(texture_number)], uv, 0.0)[channel];
}

// The nearest hit: what surface it is, and where.
void main() {
    rough.hit = report(push.scene, barycentrics);
    MicrofacetRecord record = push.mapped.rough.microfacets.at[rough.hit.material];
    NormalMapRecord map = push.mapped.maps.at[rough.hit.material];
    rough.roughness = record.roughness;
    rough.metallic = record.metallic;
    rough.slope = vec2(0.0);
    if (max(max(record.roughness_texture, record.metallic_texture), map.number) >= 0) {
        InstanceRecord instance = push.scene.instances.at[rough.hit.instance];
        Surface surface = surface_at(instance, rough.hit.triangle, barycentrics);
        rough.roughness *= texel(record.roughness_texture, surface.uv, 1);
        rough.metallic *= texel(record.metallic_texture, surface.uv, 2);
        if (map.number >= 0) {
            vec3 normal = rough.hit.normal;
            rough.slope = (slope_at(instance, rough.hit.triangle, surface, map, normal) * frame_of(normal)).xy;
        }
    }
}
