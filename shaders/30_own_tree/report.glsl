// The report of the walk on the surface its ray hit. 16 gets the same values from a ray query.
#include "common/hit.glsl"
#include "common/ray_offset.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

// The barycentrics of the second and the third corner, as the watertight test has them.
vec2 barycentrics_at(Corners corners, vec3 origin, vec3 direction) {
    uint axis = longest_axis(direction);
    vec3 d = permuted(direction, axis);
    precise vec2 slope = d.xy / d.z;
    precise vec3 p = permuted(corners.a - origin, axis);
    precise vec3 q = permuted(corners.b - origin, axis);
    precise vec3 r = permuted(corners.c - origin, axis);
    precise vec2 p_flat = p.xy - slope * p.z;
    precise vec2 q_flat = q.xy - slope * q.z;
    precise vec2 r_flat = r.xy - slope * r.z;
    float u = edge_side(r_flat, q_flat);
    float v = edge_side(p_flat, r_flat);
    float w = edge_side(q_flat, p_flat);
    precise float all = u + v + w;
    // A triangle seen edge-on, which another test has met: any point of it will do.
    return all == 0.0 ? vec2(1.0 / 3.0) : vec2(v, w) / all;
}

// The surface at the nearest hit of a walk.
void report(inout Hit hit, Met met, vec3 origin, vec3 ray) {
    Placed placed = push.trees.at[0].placed.at[met.placed];
    mat4x3 to_world = placed.to_world;
    mat4x3 to_object = placed.to_object;
    vec3 o = to_object * vec4(origin, 1.0);
    vec3 d = mat3(to_object) * ray;
    vec2 barycentrics = barycentrics_at(push.trees.at[0].corners.at[met.position], o, d);
    uint number = placed.number;
    uint primitive = met.position - placed.first;
    hit.t = met.t;
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
