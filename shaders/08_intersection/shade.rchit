#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "lighting.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

hitAttributeEXT vec2 weights;

// The nearest hit: normal, material and light give the colour.
void main() {
    // ANCHOR: fetch
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, weights);
    MaterialRecord material = push.scene.materials.at[instance.material];
    // ANCHOR_END: fetch
    // ANCHOR: normal
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    normal = faceforward(normal, gl_WorldRayDirectionEXT, normal);
    // ANCHOR_END: normal

    vec3 base = material.base_color;
    if (material.base_texture >= 0) {
        base *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    // ANCHOR: light
    HitPoint hit = hit_point(instance, triangle, weights);
    vec3 origin = origin_above(hit);
    vec3 up = hit.normal;
    if (push.smooth_terminator != 0) {
        vec3 lift = lift_to_smooth(instance, triangle, weights);
        origin += lift;
        up = lift == vec3(0.0) ? up : normal;
    }
    // ANCHOR_END: light
    show_surface(triangle, material, base, normal, origin, up);
}
