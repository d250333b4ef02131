// The report of a hit shader, the same for all patterns.
#include "common/report.glsl"

layout(location = 0) rayPayloadInEXT PatternHit seen;
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
    seen.hit = report(push.scene, barycentrics);
    InstanceRecord instance = push.scene.instances.at[seen.hit.instance];
    seen.object = object_point(instance, seen.hit.triangle, barycentrics);
    seen.weight = 0.0;
}
