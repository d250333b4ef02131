// A vertex without its position, which the acceleration structure keeps; and what its corners give.

struct Attributes {
    vec3 normal;
    vec2 uv;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer AttributesOfMesh { Attributes at[]; };

struct MeshRecord {
    AttributesOfMesh vertices;
};

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Meshes { MeshRecord at[]; };

// As in 02, but the corners are arguments, and attributes replace the vertices.
Surface surface_at(vec3 corners[3], MeshRecord mesh, uvec3 index, vec2 barycentrics) {
    Attributes a = mesh.vertices.at[index.x];
    Attributes b = mesh.vertices.at[index.y];
    Attributes c = mesh.vertices.at[index.z];
    vec3 w = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    Surface surface;
    surface.normal = w.x * a.normal + w.y * b.normal + w.z * c.normal;
    surface.face = cross(corners[1] - corners[0], corners[2] - corners[0]);
    surface.uv = w.x * a.uv + w.y * b.uv + w.z * c.uv;
    return surface;
}

// The corners of a triangle of the model, from our own vertices.
vec3[3] corners_at(InstanceRecord instance, uint triangle) {
    uvec3 index = instance.triangles.at[triangle];
    return vec3[](
        instance.vertices.at[index.x].position,
        instance.vertices.at[index.y].position,
        instance.vertices.at[index.z].position);
}

// The point with these barycentric coordinates, in object space.
vec3 point_at(vec3 corners[3], vec2 barycentrics) {
    return corners[0] + barycentrics.x * (corners[1] - corners[0]) + barycentrics.y * (corners[2] - corners[0]);
}
