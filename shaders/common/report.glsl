// Taught by 06_reflection.
//
// The report of a closest hit shader on the triangle that a ray hit.
#include "common/hit_point.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

// The built-in variables of a hit shader say which surface it is.
Hit report(SceneAddresses scene, vec2 barycentrics) {
    InstanceRecord instance = scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = scene.materials.at[instance.material];
    Hit hit;
    HitPoint at = hit_point(instance, triangle, barycentrics);
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    // The triangle's own normal decides which side is seen: near an outline the smooth one may look away.
    hit.normal = faceforward(normal, -hit.face, normal);

    // ANCHOR: texture
    hit.color = material.base_color;
    if (material.base_texture >= 0) {
        hit.color *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    // ANCHOR_END: texture
    hit.material = instance.material;
    hit.triangle = triangle;
    hit.instance = gl_InstanceCustomIndexEXT;
    return hit;
}
