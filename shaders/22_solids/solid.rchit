#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/offset.glsl"
#include "common/start.glsl"
#include "lighting.glsl"
#include "common/board.glsl"

// The part and the face that the ray goes through.
hitAttributeEXT uvec2 crossed;

// Where on the solid, and how far off it the next ray must start.
HitPoint here;

Start start_from(Met met, vec3 direction) {
    return met.on_plane ? Start(met.position, 0.0) : Start(origin_above(here), 0.0);
}

// ANCHOR: point
// The hit again, from the face and not from the ray, in the solid's own space: its point, the normal of
// the face, and by how much, in units of ROUNDING, the next ray may find it on the wrong side.
//
// Plane: brought onto it, the point is off by the rounding of the last sum, |p|. The next ray's height
// is a sum of products with the distances to the anchor, or from the origin: 4 roundings of those.
// Ball: as in shape.rchit of chapter 08, 24 roundings of the radius.
vec3 point_of_face(Face face, out vec3 normal, out vec3 straying) {
    precise vec3 p = gl_ObjectRayOriginEXT + gl_HitTEXT * gl_ObjectRayDirectionEXT;
    if (face.kind == FACE_BALL) {
        Ball ball = push.world.solids.balls.at[face.index];
        normal = normalize(p - ball.center);
        precise vec3 point = ball.center + ball.radius * normal;
        straying = abs(point) + vec3(24.0 * ball.radius);
        return point;
    }
    Plane plane = push.world.solids.planes.at[face.index];
    precise float off = height_below(plane, p) / dot(plane.normal, plane.normal);
    precise vec3 point = p + off * plane.normal;
    normal = normalize(plane.normal);
    straying = 6.0 * abs(point) + 4.0 * abs(plane.anchor);
    return point;
}

// From there to the world, by the bound of common/offset.glsl.
HitPoint solid_point(vec3 point, vec3 normal, vec3 own) {
    precise vec3 world = vec3(gl_ObjectToWorldEXT * vec4(point, 1.0));
    mat3 linear = absolute(mat3(gl_ObjectToWorldEXT));
    mat3 inverse = absolute(mat3(gl_WorldToObjectEXT));
    vec3 shift = abs(gl_ObjectToWorldEXT[3]);
    vec3 reach = linear * abs(point);
    vec3 straying = linear * own + 4.0 * (reach + shift) + abs(world)
        + linear * (inverse * (18.0 * reach + 7.0 * (abs(world) + shift)));
    return HitPoint(world, normal, ROUNDING * dot(abs(normal), straying));
}
// ANCHOR_END: point

// The nearest hit is a solid.
void main() {
    if (PLANE_TEST == PLANE_AFTER && payload.plane <= gl_HitTEXT) {
        shade_plane();
        return;
    }
    // ANCHOR: fetch
    SolidRecord solid = push.world.solids.solids.at[gl_InstanceCustomIndexEXT - push.world.first_solid];
    Part part = push.world.solids.parts.at[solid.first_part + crossed.x];
    Face face = push.world.solids.faces.at[crossed.y];
    // ANCHOR_END: fetch
    // ANCHOR: normal
    vec3 normal;
    vec3 straying;
    vec3 point = point_of_face(face, normal, straying);
    // Out of the solid, whichever part has the face: against a ray that comes in, along one that goes
    // out. And that is the side seen, turned to the eye.
    normal = normalize(vec3(normal * gl_WorldToObjectEXT));
    normal = faceforward(normal, gl_WorldRayDirectionEXT, normal);
    // ANCHOR_END: normal
    here = solid_point(point, normal, straying);

    Met met;
    met.t = gl_HitTEXT;
    met.position = here.position;
    met.normal = normal;
    met.flat_normal = normal;
    met.lift = vec3(0.0);
    met.up = normal;
    met.on_plane = false;
    met.curvature = 0.0;
    if (face.kind == FACE_BALL) {
        float radius = push.world.solids.balls.at[face.index].radius;
        met.curvature = 1.0 / (radius * length(gl_ObjectToWorldEXT[0]));
    }
    met.material = push.scene.materials.at[part.material];
    met.reflection = push.world.reflections.at[part.material];
    // The place of the face among those of its solid, and whether the ray was inside.
    uint number = crossed.y - push.world.solids.parts.at[solid.first_part].first_face;
    shade(met, vec4(gl_InstanceCustomIndexEXT, number, gl_HitTEXT, float(gl_HitKindEXT)),
          false_color(number));
}
