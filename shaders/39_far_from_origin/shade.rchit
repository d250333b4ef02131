#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "common/hit_point.glsl"
#include "common/instance.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

layout(location = 0) rayPayloadInEXT PieceHit seen;
hitAttributeEXT vec2 barycentrics;

// From the mesh's space to the world, not of unit length. The matrix is right only if it turns and no
// more: whatever stretches a surface one way must turn its normal the other way.
vec3 world_normal(PieceRecord piece, vec3 normal) {
    if (NORMALS == NORMALS_MATRIX) {
        return mat3(gl_ObjectToWorldEXT) * normal;
    }
    // A row vector times a matrix is the product with the transpose.
    if (NORMALS == NORMALS_DEVICE_INVERSE) {
        return vec3(normal * gl_WorldToObjectEXT);
    }
    return normal * piece.inverse;
}

// The ray's origin in the mesh's space.
vec3 object_origin(PieceRecord piece) {
    if (OBJECT_RAY == OBJECT_RAY_DEVICE) {
        return gl_ObjectRayOriginEXT;
    }
    if (OBJECT_RAY == OBJECT_RAY_MATRIX) {
        return object_origin_matrix(gl_WorldToObjectEXT, gl_WorldRayOriginEXT);
    }
    return object_origin_inverse(piece.inverse, piece.at, gl_WorldRayOriginEXT);
}

// The nearest hit: what surface it is, and where.
void main() {
    PieceRecord piece = push.pieces.at[gl_InstanceCustomIndexEXT];
    InstanceRecord instance = push.scene.instances.at[piece.mesh];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = push.scene.materials.at[piece.material];
    Hit hit;
    HitPoint at = hit_point(instance, triangle, barycentrics);
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    vec3 normal = normalize(world_normal(piece, surface.normal));
    // The triangle's own normal decides which side is seen: near an outline the smooth one may look away.
    hit.normal = faceforward(normal, -hit.face, normal);

    hit.color = material.base_color * piece.tone;
    if (material.base_texture >= 0) {
        hit.color *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    hit.material = piece.material;
    hit.triangle = triangle;
    hit.instance = gl_InstanceCustomIndexEXT;
    seen.hit = hit;
    seen.place = gl_InstanceID;
    seen.object = SHOW == SHOW_OBJECT_ORIGIN ? object_origin(piece) : surface.normal;
}
