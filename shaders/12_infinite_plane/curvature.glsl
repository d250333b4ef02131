// The curvature of the surface that a ray met.

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
