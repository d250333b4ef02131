#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"
#include "time.glsl"
#include "common/ray_offset.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec2 barycentrics;

// The inverse of a matrix, by its cofactors.
mat4x3 inverted(const mat4x3 m) {
    vec3 rows[3] = vec3[3](cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    float determinant = dot(m[0], rows[0]);
    mat4x3 inverse;
    for (int i = 0; i < 3; i++) {
        inverse[i] = vec3(rows[0][i], rows[1][i], rows[2][i]) / determinant;
    }
    inverse[3] = -(mat3(inverse) * m[3]);
    return inverse;
}

// The nearest hit: what surface it is, and where. One that was moved by the intersection shader is where that has
// moved it, for the same ray carries the same time.
void main() {
    mat4x3 to_world = gl_ObjectToWorldEXT;
    mat4x3 to_object = gl_WorldToObjectEXT;
    uint record = gl_InstanceCustomIndexEXT & ~UNDER_WAY;
    if (gl_HitKindEXT == HIT_MOVED) {
        Mover mover = push.movers.at[record];
        to_world = pose_at(mover, time_of(gl_RayTminEXT));
        to_object = inverted(to_world);
        record = mover.record;
    }
    InstanceRecord instance = push.scene.instances.at[record];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = push.scene.materials.at[instance.material];
    HitPoint at = hit_point(instance, triangle, barycentrics, to_world, to_object, gl_WorldRayDirectionEXT);
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
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
    hit.instance = record | (gl_InstanceCustomIndexEXT & UNDER_WAY);
}
