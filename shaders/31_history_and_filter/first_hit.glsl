// The first hit of a path: the surface whose light is kept from frame to frame.

// The sine of the largest angle between a triangle and the normals of its corners: 0 where the surface is flat. It is
// that of the mesh's own space, so an instance may be turned and enlarged, but not stretched.
float bend(Hit hit) {
    InstanceRecord instance = push.scene.instances.at[hit.instance];
    uvec3 corner = instance.triangles.at[hit.triangle];
    Vertex a = instance.vertices.at[corner.x];
    Vertex b = instance.vertices.at[corner.y];
    Vertex c = instance.vertices.at[corner.z];
    vec3 face = normalize(cross(b.position - a.position, c.position - a.position));
    float most = 0.0;
    for (uint i = 0; i < 3; i++) {
        vec3 normal = normalize(instance.vertices.at[corner[i]].normal);
        most = max(most, length(cross(face, normal)));
    }
    return min(most, 1.0);
}

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
    surface.rest = is_sky ? packed_rest(NOTHING, 1, 0.0) : packed_rest(hit.instance, 1, bend(hit));
    push.pixels.surfaces.at[index] = surface;
    uint stored = packed_color(color);
    push.pixels.colors.at[index] = stored;
    return unpacked_color(stored);
}
