#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"
#include "common/hit_point.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec2 barycentrics;

// The nearest hit: what surface it is, and where.
void main() {
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = push.scene.materials.at[instance.material];
    HitPoint at = hit_point(instance, triangle, barycentrics);
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    // The triangle's own normal decides which side is seen: near an outline the smooth one may look away.
    hit.normal = faceforward(normal, -hit.face, normal);

    hit.color = material.base_color;
    if (material.base_texture >= 0) {
        hit.color *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    hit.material = instance.material;
    hit.triangle = triangle;
    hit.instance = gl_InstanceCustomIndexEXT;
}
