// Taught by 31_history_and_filter.
//
// The deviation of a triangle's normals from its plane.
#include "common/scene.glsl"

// The sine of the largest angle between a triangle and the normals of its corners: 0 where the surface is flat. It is
// that of the mesh's own space, so an instance may be turned and enlarged, but not stretched.
float bend(InstanceRecord instance, uint triangle) {
    uvec3 corner = instance.triangles.at[triangle];
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
