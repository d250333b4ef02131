// What a hit shader reports of the surface that a ray met.
#include "common/hit_point.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

// By how much the normal turns in a unit of length: from the triangle's corners, along its edges.
float curvature(InstanceRecord instance, uint triangle) {
    uvec3 corner = instance.triangles.at[triangle];
    float most = 0.0;
    for (int i = 0; i < 3; i++) {
        Vertex a = instance.vertices.at[corner[i]];
        Vertex b = instance.vertices.at[corner[(i + 1) % 3]];
        vec3 edge = gl_ObjectToWorldEXT * vec4(b.position - a.position, 0.0);
        most = max(most, length(b.normal - a.normal) / length(edge));
    }
    return most;
}

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
    hit.curvature = curvature(instance, triangle);
    return hit;
}
