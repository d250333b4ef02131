// Taught by 36_two_normals.

// From the flat triangle to the round surface that its normals pretend: the mean of the point's
// projections onto the planes through the corners, across their normals, where those lie above it.
// A shadow ray from there does not show the triangles where light turns into shade (Hanika, "Hacking
// the Shadow Terminator", Ray Tracing Gems II, chapter 4). Zero on flat and on hollow surfaces.
vec3 terminator_offset(vec3 face, InstanceRecord instance, uint triangle, vec2 barycentrics,
        const mat4x3 to_world) {
    uvec3 corner = instance.triangles.at[triangle];
    vec3 w = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    Vertex corners[3];
    vec3 point = vec3(0.0);
    for (uint k = 0; k < 3; k++) {
        corners[k] = instance.vertices.at[corner[k]];
        point += w[k] * corners[k].position;
    }
    vec3 up = face * mat3(to_world);
    vec3 offset = vec3(0.0);
    for (uint k = 0; k < 3; k++) {
        vec3 normal = corners[k].normal;
        normal = faceforward(normal, -up, normal);
        offset -= w[k] * min(dot(point - corners[k].position, normal), 0.0) * normal;
    }
    return mat3(to_world) * offset;
}
