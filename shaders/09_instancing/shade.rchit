#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/offset.glsl"
#include "common/instance.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
layout(set = 1, binding = 0) uniform sampler2D textures[];

layout(location = 0) rayPayloadInEXT vec4 payload;
layout(location = 1) rayPayloadEXT bool lit;
hitAttributeEXT vec2 weights;

// ANCHOR: shadow
// Whether nothing lies between a point and the light, or a point of the light.
bool is_lit(vec3 origin, vec3 to_light) {
    // Any hit will do, and no closest hit shader needs to hear of it. Which instances are opaque, their
    // flags say.
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
    if (push.shadow_rays == SHADOW_NEAREST_HIT) {
        flags &= ~gl_RayFlagsTerminateOnFirstHitEXT;
    }
    lit = false;
    traceRayEXT(
        tlas,
        flags,
        push.shadow_mask,           // cull mask: instances that share a bit
        0,                          // sbtRecordOffset: the record whose any-hit shader may be asked
        1,                          // sbtRecordStride: one record a geometry
        1,                          // missIndex: shadow.rmiss
        origin,
        0.0,                        // tmin: the origin lies off the surface
        to_light,
        light_end(push.light),      // tmax
        1                           // payload location
    );
    return lit;
}
// ANCHOR_END: shadow

// ANCHOR: visibility
// What part of the light is seen, 0 to 1, by a surface whose normal is `up`. One ray tells if the light
// has no size.
float visibility(vec3 origin, vec3 up) {
    if (push.shadow_rays == SHADOW_OFF) {
        return 1.0;
    }
    bool soft = push.light.size > 0.0;
    uint count = soft ? push.light_samples : 1;
    uvec2 pixel = gl_LaunchIDEXT.xy + uvec2(push.first_column, 0);
    vec2 start = random(pixel, 0, 0, DIMENSION_LIGHT).xy;
    uint seen = 0;
    for (uint i = 0; i < count; i++) {
        vec2 point = soft ? disk_point(i, count, start) : vec2(0.0);
        vec3 to_light = towards_light(push.light, origin, point);
        // What is below the surface, the surface itself hides; that needs no ray.
        if (dot(up, to_light) > 0.0 && is_lit(origin, to_light)) {
            seen++;
        }
    }
    return float(seen) / float(count);
}
// ANCHOR_END: visibility

// ANCHOR: world_normal
// From the mesh's space to the world, not of unit length. The matrix is right only if it turns and no
// more: whatever stretches a surface one way must turn its normal the other way.
vec3 world_normal(PieceRecord piece, vec3 normal) {
    if (push.normals == NORMALS_MATRIX) {
        return mat3(gl_ObjectToWorldEXT) * normal;
    }
    // A row vector times a matrix is the product with the transpose.
    if (push.normals == NORMALS_DEVICE_INVERSE) {
        return vec3(normal * gl_WorldToObjectEXT);
    }
    return normal * piece.inverse;
}
// ANCHOR_END: world_normal

// The ray's origin in the mesh's space.
vec3 object_origin(PieceRecord piece) {
    if (push.object_ray == OBJECT_RAY_DEVICE) {
        return gl_ObjectRayOriginEXT;
    }
    if (push.object_ray == OBJECT_RAY_MATRIX) {
        return object_origin_matrix(gl_WorldToObjectEXT, gl_WorldRayOriginEXT);
    }
    return object_origin_inverse(piece.inverse, piece.at, gl_WorldRayOriginEXT);
}

// The nearest hit: normal, material and light give the colour.
void main() {
    // ANCHOR: fetch
    uint index = gl_InstanceCustomIndexEXT;
    uint place = gl_InstanceID;
    PieceRecord piece = push.pieces.at[index];
    InstanceRecord instance = push.scene.instances.at[piece.mesh];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, weights);
    MaterialRecord material = push.scene.materials.at[piece.material];
    // ANCHOR_END: fetch
    // ANCHOR: normal
    vec3 normal = normalize(world_normal(piece, surface.normal));
    vec3 view = -gl_WorldRayDirectionEXT;
    // Which side is seen, the triangle says: near an outline its smooth normal may look away.
    HitPoint hit = hit_point(instance, triangle, weights);
    normal = faceforward(normal, -hit.normal, normal);
    // ANCHOR_END: normal

    vec3 base = material.base_color * piece.tone;
    if (material.base_texture >= 0) {
        base *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    // ANCHOR: light
    vec3 origin = origin_above(hit);
    vec3 up = hit.normal;
    if (push.smooth_terminator != 0) {
        vec3 lift = lift_to_smooth(hit, instance, triangle, weights);
        origin += lift;
        up = lift == vec3(0.0) ? up : normal;
    }
    float visible = visibility(origin, up);
    vec3 light = normalize(towards_light(push.light, origin, vec2(0.0)));
    vec3 color = material.emission + base * ambient(normal);
    color += visible * arriving_light(push.light, origin)
        * reflect_light(base, material.specular, material.shininess, normal, view, light);
    // ANCHOR_END: light

    payload = vec4(color, 1.0);
    if (push.show == SHOW_NORMAL) {
        payload.rgb = 0.5 + 0.5 * normal;
    }
    if (push.show == SHOW_TRIANGLE) {
        payload.rgb = false_color(triangle);
    }
    if (push.show == SHOW_HIT) {
        payload = vec4(index, triangle, gl_HitTEXT, place);
    }
    if (push.show == SHOW_DIRECTION) {
        payload = vec4(gl_WorldRayDirectionEXT, gl_HitTEXT);
    }
    if (push.show == SHOW_SHADOW) {
        payload.rgb = vec3(visible);
    }
    if (push.show == SHOW_ORIGIN) {
        payload = vec4(origin, visible);
    }
    if (push.show == SHOW_OBJECT_NORMAL) {
        payload = vec4(surface.normal, float(index));
    }
    if (push.show == SHOW_OBJECT_ORIGIN) {
        payload = vec4(object_origin(piece), float(index));
    }
}
