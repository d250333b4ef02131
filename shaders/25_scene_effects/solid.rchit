#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "lighting.glsl"
#include "shape_start.glsl"

hitAttributeEXT uint face;

// The nearest hit is a face of a convex solid.
void main() {
    Solid solid = push.world.solids.at[gl_PrimitiveID];
    Face wall = push.world.faces.at[solid.first + face];
    MaterialRecord material = push.scene.materials.at[solid.material];
    // Onto the face, which rounding has left.
    precise vec3 f = gl_WorldRayOriginEXT - solid.center + gl_HitTEXT * gl_WorldRayDirectionEXT;
    precise vec3 on_face = f + (wall.distance - dot(wall.normal, f)) * wall.normal;
    precise vec3 point = solid.center + on_face;
    vec3 normal = faceforward(wall.normal, gl_WorldRayDirectionEXT, wall.normal);
#ifdef DEPARTURES
    // The point is off by a few roundings of its distance from the centre, and the next ray's test,
    // a sum of three products, by as many.
    note_height(point, normal, abs(point) + vec3(12.0 * length(on_face)));
#endif

    Met met;
    met.t = gl_HitTEXT;
    met.position = point;
    met.normal = normal;
    met.flat_normal = normal;
    met.lift = vec3(0.0);
    met.up = normal;
    met.on_plane = false;
    met.curvature = 0.0;
    met.base_color = material.base_color;
    met.specular = material.specular;
    met.shininess = material.shininess;
    met.emission = material.emission;
    met.reflection = mirrors(material);
    shade(met);
}
