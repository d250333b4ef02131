#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "offset.glsl"
#include "origin.glsl"
#include "lighting.glsl"

#ifdef EFFECT_TEXTURES
layout(set = 1, binding = 0) uniform sampler2D textures[];
#endif

hitAttributeEXT vec2 weights;

#ifdef DEPARTURES
// The point of the triangle that was hit.
Departure from;

Start start_from(Met met, vec3 direction) {
    return start_bound(from, direction);
}
#endif

#if defined(EFFECT_MIRROR) && defined(SQUARES)
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
#endif

// The nearest hit is a triangle.
void main() {
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, weights);
    MaterialRecord material = push.scene.materials.at[instance.material];
    HitPoint hit = hit_point(instance, triangle, weights);
    // Which side is seen, the triangle says: near an outline its smooth normal may look away.
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    normal = faceforward(normal, -hit.normal, normal);

    Met met;
    met.t = gl_HitTEXT;
    met.position = hit.position;
    met.normal = normal;
    met.flat_normal = hit.normal;
    met.lift = vec3(0.0);
    met.up = hit.normal;
#ifdef DEPARTURES
    from = departure(hit, instance, triangle, weights);
#endif
#ifdef SHADOWS
    met.lift = lift_to_smooth(hit, instance, triangle, weights);
    met.up = met.lift == vec3(0.0) ? met.up : normal;
#endif
    met.on_plane = false;
    met.curvature = 0.0;
#if defined(EFFECT_MIRROR) && defined(SQUARES)
    met.curvature = curvature(instance, triangle);
#endif
    met.base_color = material.base_color;
#ifdef EFFECT_TEXTURES
    if (material.base_texture >= 0) {
        met.base_color *=
            textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
#endif
    met.specular = material.specular;
    met.shininess = material.shininess;
    met.emission = material.emission;
    met.reflection = mirrors(material);
    shade(met);
}
