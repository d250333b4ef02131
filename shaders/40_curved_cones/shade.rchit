#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/heat.glsl"
#include "common/hit.glsl"
#include "common/hit_point.glsl"
#include "seen.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

#include "common/lookup.glsl"

layout(location = 0) rayPayloadInEXT Seen seen;
hitAttributeEXT vec2 barycentrics;

// The lookups in a texture of this size.
Row chosen(InstanceRecord instance, uint triangle, vec3 face, vec2 size) {
    if (FOOTPRINT == FOOTPRINT_POINT) {
        return Row(vec2(0.0), 1, 0.0);
    }
    uvec3 corner = instance.triangles.at[triangle];
    Vertex a = instance.vertices.at[corner.x];
    Vertex b = instance.vertices.at[corner.y];
    Vertex c = instance.vertices.at[corner.z];
    // In the world: an instance may be larger than its mesh.
    vec3 e1 = mat3(gl_ObjectToWorldEXT) * (b.position - a.position);
    vec3 e2 = mat3(gl_ObjectToWorldEXT) * (c.position - a.position);
    Mapping mapping = mapping_of(e1, e2, b.uv - a.uv, c.uv - a.uv);

    vec3 direction = gl_WorldRayDirectionEXT;
#ifdef DIFFERENTIALS
    Axes axes = principal(met(seen.beam, gl_HitTEXT, direction, face));
#else
    // ANCHOR: width
    // Beyond a focus the cone's sides have changed places, and its width is negative.
    float width = abs(width_at(seen.cone, gl_HitTEXT));
    Axes axes = ellipse(width, direction, face);
    // ANCHOR_END: width
#endif
    return row_of(on_texture(mapping, axes.a), on_texture(mapping, axes.b), size);
}

// ANCHOR: curvature
// The angle between the normals of two corners, along the edge between them.
float turn(vec3 edge, vec3 normals) {
    return dot(normals, edge) / max(dot(edge, edge), 1e-30);
}

// 1 / radius of the round surface that a triangle stands for, on the side where its normals point: the mean of three
// edges, each of which is exact on a sphere.
float curvature_of(InstanceRecord instance, uint triangle) {
    uvec3 corner = instance.triangles.at[triangle];
    vec3 at[3];
    vec3 normal[3];
    for (uint i = 0; i < 3; i++) {
        Vertex vertex = instance.vertices.at[corner[i]];
        at[i] = mat3(gl_ObjectToWorldEXT) * vertex.position;
        normal[i] = normalize(vec3(vertex.normal * gl_WorldToObjectEXT));
    }
    return (turn(at[1] - at[0], normal[1] - normal[0]) + turn(at[2] - at[1], normal[2] - normal[1])
        + turn(at[0] - at[2], normal[0] - normal[2])) / 3.0;
}
// ANCHOR_END: curvature

// The nearest hit: what surface it is, and where.
void main() {
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = push.scene.materials.at[instance.material];
    Hit hit;
    HitPoint at = hit_point(instance, triangle, barycentrics);
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    // The triangle's own normal decides which side is seen: near an outline the smooth one may look away.
    hit.normal = faceforward(normal, -hit.face, normal);
    // Seen from the other side, what bulges is hollow.
    float curvature = material.base_color == vec3(0.0) ? curvature_of(instance, triangle) : 0.0;
    seen.curvature = dot(hit.normal, normal) < 0.0 ? -curvature : curvature;

    // Without a texture there is no level.
    hit.color = SHOW == SHOW_LEVEL ? vec3(0.2) : material.base_color;
    if (material.base_texture >= 0) {
        int index = material.base_texture;
        Row row = chosen(instance, triangle, hit.face, vec2(textureSize(textures[nonuniformEXT(index)], 0)));
        hit.color *= texture_along(index, surface.uv, row);
        if (SHOW == SHOW_LEVEL) {
            hit.color = heat(0.1 * row.level);
        }
    }
    hit.material = instance.material;
    hit.triangle = triangle;
    hit.instance = gl_InstanceCustomIndexEXT;
    seen.hit = hit;
}
