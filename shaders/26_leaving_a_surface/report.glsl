// What a hit shader reports of the surface that a ray met.
#include "common/hit_point.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

// The built-in variables of a hit shader say which surface it is.
Hit report(vec2 barycentrics) {
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = push.scene.materials.at[instance.material];
    Hit hit;
    hit_point(hit, instance, triangle, barycentrics);
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
    hit.barycentrics = barycentrics;
    hit.to_mesh = gl_WorldToObjectEXT;
    return hit;
}
