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
    float width = width_at(seen.cone, gl_HitTEXT);
    if (FOOTPRINT == FOOTPRINT_CONE) {
        float texels = texels_of_cone(width, dot(direction, face), mapping, size);
        return Row(vec2(0.0), 1, level_of(texels));
    }
    Axes axes = ellipse(width, direction, face);
    if (FOOTPRINT == FOOTPRINT_DIFFERENTIALS) {
        // The picture plane is at distance 1 along `forward`, so the ray hits it at 1 / dot(direction, forward).
        float step = seen.cone.spread * dot(direction, push.camera.forward);
        vec3 right = step * normalize(push.camera.right);
        vec3 down = -step * normalize(push.camera.up);
        axes = differentials(gl_HitTEXT, direction, face, right, down);
    }
    return row_of(on_texture(mapping, axes.a), on_texture(mapping, axes.b), size);
}

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
