#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "rough_hit.glsl"
#include "common/report.glsl"

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
    MicrofacetRecord record = push.rough.microfacets.at[rough.hit.material];
    rough.roughness = record.roughness;
    rough.metallic = record.metallic;
    if (max(record.roughness_texture, record.metallic_texture) >= 0) {
        InstanceRecord instance = push.scene.instances.at[rough.hit.instance];
        vec2 uv = surface_at(instance, rough.hit.triangle, barycentrics).uv;
        rough.roughness *= texel(record.roughness_texture, uv, 1);
        rough.metallic *= texel(record.metallic_texture, uv, 2);
    }
}
