// The report of a ray query on the surface it hit. It calls functions for everything that 05's closest hit
// shader reads from built-in variables.
#include "push.glsl"
#include "common/hit.glsl"
#include "common/ray_offset.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

// The nearest hit of a query that is done: what surface it is, and where. `true` asks for the committed
// intersection; `false` would ask for the candidate.
void report(inout Hit hit, rayQueryEXT query) {
    // ANCHOR: questions
    uint number = rayQueryGetIntersectionInstanceCustomIndexEXT(query, true);
    uint primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, true);
    vec2 barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, true);
    mat4x3 to_world = rayQueryGetIntersectionObjectToWorldEXT(query, true);
    mat4x3 to_object = rayQueryGetIntersectionWorldToObjectEXT(query, true);
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    vec3 ray = rayQueryGetWorldRayDirectionEXT(query);
    // ANCHOR_END: questions
    InstanceRecord instance = push.scene.instances.at[number];
    uint triangle = instance.original.at[primitive];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = push.scene.materials.at[instance.material];
    HitPoint at = hit_point(instance, triangle, barycentrics, to_world, to_object, ray);
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 normal = normalize(vec3(surface.normal * to_object));
    // The triangle's own normal decides which side is seen: near an outline the smooth one may look away.
    hit.normal = faceforward(normal, -hit.face, normal);

    hit.color = material.base_color;
    if (material.base_texture >= 0) {
        hit.color *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    hit.material = instance.material;
    hit.triangle = triangle;
    hit.instance = number;
}
