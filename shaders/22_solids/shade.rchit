#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/offset.glsl"
#include "common/origin.glsl"
#include "lighting.glsl"
#include "common/board.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

hitAttributeEXT vec2 weights;

// The point of the triangle that was hit.
Departure from;

Start start_from(Met met, vec3 direction) {
    return met.on_plane ? Start(met.position, 0.0) : start_of_ray(push.origin, from, direction);
}

// ANCHOR: curvature
// By how much the normal turns in a unit of length: from the triangle's corners, along its edges.
float curvature(InstanceRecord instance, uint triangle) {
    uvec3 corner = instance.triangles.at[triangle];
    float most = 0.0;
    for (int i = 0; i < 3; i++) {
        Vertex a = instance.vertices.at[corner[i]];
        Vertex b = instance.vertices.at[corner[(i + 1) % 3]];
        vec3 edge = gl_ObjectToWorldEXT * vec4(b.position - a.position, 0.0);
        most = max(most, length(b.normal - a.normal) / length(edge));
    }
    return most;
}
// ANCHOR_END: curvature

// The nearest hit: normal, material and light give the colour.
void main() {
    // ANCHOR: after
    // Tested after: the trace went on behind the plane, and all for nothing.
    if (PLANE_TEST == PLANE_AFTER && payload.plane <= gl_HitTEXT) {
        shade_plane();
        return;
    }
    // ANCHOR_END: after
    // ANCHOR: fetch
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, weights);
    MaterialRecord material = push.scene.materials.at[instance.material];
    // ANCHOR_END: fetch
    // ANCHOR: normal
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    // Which side is seen, the triangle says: near an outline its smooth normal may look away.
    HitPoint hit = hit_point(instance, triangle, weights);
    normal = faceforward(normal, -hit.normal, normal);
    // ANCHOR_END: normal

    if (material.base_texture >= 0) {
        vec4 texel = textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0);
        material.base_color *= texel.rgb;
    }
    // ANCHOR: met
    from = departure(hit, instance, triangle, weights);
    Met met;
    met.t = gl_HitTEXT;
    met.position = hit.position;
    met.normal = normal;
    met.flat_normal = hit.normal;
    met.lift = vec3(0.0);
    met.up = hit.normal;
    if (push.smooth_terminator != 0) {
        met.lift = lift_to_smooth(hit, instance, triangle, weights);
        met.up = met.lift == vec3(0.0) ? met.up : normal;
    }
    met.on_plane = false;
    met.curvature = curvature(instance, triangle);
    met.material = material;
    met.reflection = push.world.reflections.at[instance.material];
    // ANCHOR_END: met
    shade(met, vec4(gl_InstanceCustomIndexEXT, triangle, gl_HitTEXT, gl_InstanceID), false_color(triangle));
}
