// What a hit shader reports, whatever the surface's pattern is.

layout(set = 1, binding = 0) uniform sampler2D textures[];

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec2 barycentrics;

// The point with these barycentric coordinates, in the mesh's own space.
vec3 object_point(InstanceRecord instance, uint triangle, vec2 w) {
    uvec3 corner = instance.triangles.at[triangle];
    vec3 a = instance.vertices.at[corner.x].position;
    vec3 e1 = instance.vertices.at[corner.y].position - a;
    vec3 e2 = instance.vertices.at[corner.z].position - a;
    return a + w.x * e1 + w.y * e2;
}

// The nearest hit: what surface it is, and where.
void report() {
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = push.scene.materials.at[instance.material];
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
    hit.object = object_point(instance, triangle, barycentrics);
    hit.weight = 0.0;
}
