#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/offset.glsl"
#include "lighting.glsl"

layout(set = 1, binding = 0) uniform sampler2D textures[];

hitAttributeEXT vec2 weights;

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
    vec3 view = -gl_WorldRayDirectionEXT;
    normal = faceforward(normal, -view, normal);
    // ANCHOR_END: normal

    vec3 base = material.base_color;
    if (material.base_texture >= 0) {
        base *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }

    Met met;
    met.t = gl_HitTEXT;
    met.normal = normal;
    met.from = departure(instance, triangle, weights);
    met.lift = vec3(0.0);
    met.up = met.from.normal;
    if (push.smooth_terminator != 0) {
        met.lift = lift_to_smooth(instance, triangle, weights);
        met.up = met.lift == vec3(0.0) ? met.up : normal;
    }
    met.on_plane = false;
    met.curvature = curvature(instance, triangle);
    met.base = base;
    met.emission = material.emission;
    met.specular = material.specular;
    met.shininess = material.shininess;
    met.reflection = push.reflections.at[instance.material];
    shade(met, vec4(gl_InstanceCustomIndexEXT, triangle, gl_HitTEXT, gl_InstanceID), false_color(triangle));
}
