// Taught by 02_basic.
//
// The data of the triangle a ray hit: addresses lead from the instance to its mesh.

struct Vertex {
    vec3 position;
    vec3 normal;
    vec2 uv;
};

struct MaterialRecord {
    vec3 base_color;
    float opacity;
    vec3 specular;
    float shininess;
    vec3 emission;
    int base_texture;     // -1 for none
    int opacity_texture;
    uint illumination;
};

// ANCHOR: vertices
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vertices { Vertex at[]; };
// ANCHOR_END: vertices
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Triangles { uvec3 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Original { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Materials { MaterialRecord at[]; };

// ANCHOR: instance
struct InstanceRecord {
    Vertices vertices;
    Triangles triangles;
    Original original;    // primitive i of the build is triangle original.at[i] of the model
    uint material;
    uint mesh;
};

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Instances { InstanceRecord at[]; };
// ANCHOR_END: instance

struct SceneAddresses {
    Instances instances;
    Materials materials;
};

struct Surface {
    vec3 normal;          // object space, interpolated, not normalised
    vec3 face;            // the triangle's own normal, likewise
    vec2 uv;
};

// Interpolates the vertices of a triangle; `barycentrics` are the hit attributes, the second and third
// barycentric coordinates.
Surface surface_at(InstanceRecord instance, uint triangle, vec2 barycentrics) {
    // ANCHOR: corner
    uvec3 corner = instance.triangles.at[triangle];
    Vertex a = instance.vertices.at[corner.x];
    // ANCHOR_END: corner
    Vertex b = instance.vertices.at[corner.y];
    Vertex c = instance.vertices.at[corner.z];
    vec3 w = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    Surface surface;
    surface.normal = w.x * a.normal + w.y * b.normal + w.z * c.normal;
    surface.face = cross(b.position - a.position, c.position - a.position);
    surface.uv = w.x * a.uv + w.y * b.uv + w.z * c.uv;
    return surface;
}
