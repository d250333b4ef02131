#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "rough_hit.glsl"
#include "common/frame.glsl"
#include "common/report.glsl"
#include "tangents.glsl"

layout(location = 0) rayPayloadInEXT RoughHit rough;
hitAttributeEXT vec2 barycentrics;

// Green is roughness and blue is metalness, as in glTF; textures without a curve for the eye.
float texel(int texture_number, vec2 uv, int channel) {
    return texture_number < 0 ? 1.0
        : textureLod(textures[nonuniformEXT(texture_number)], uv, 0.0)[channel];
}

// ANCHOR: mapped
// The slope that a normal map has at the hit.
vec2 slope_at(InstanceRecord instance, NormalMapRecord map, Surface surface, Hit hit) {
    uvec3 corner = instance.triangles.at[hit.triangle];
    Vertex a = instance.vertices.at[corner.x];
    Vertex b = instance.vertices.at[corner.y];
    Vertex c = instance.vertices.at[corner.z];
    mat3 to_world = mat3(gl_ObjectToWorldEXT);
    mat2x3 sides = mat2x3(to_world * (b.position - a.position), to_world * (c.position - a.position));
    mat2x3 axes = texture_axes(sides, mat2(b.uv - a.uv, c.uv - a.uv), hit.normal);
    vec3 texel = textureLod(textures[nonuniformEXT(map.number)], surface.uv, 0.0).xyz;
    // `hit.normal` is on the side that is seen, and the map is made for the other one if that was turned.
    bool is_behind = dot(vec3(surface.normal * gl_WorldToObjectEXT), hit.normal) < 0.0;
    return mapped_slope(texel_slope(texel, map.scale), axes, frame_of(hit.normal), is_behind);
}
// ANCHOR_END: mapped

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
            rough.slope = slope_at(instance, map, surface, rough.hit);
        }
    }
}
