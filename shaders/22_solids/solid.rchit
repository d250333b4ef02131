#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "common/hit_point.glsl"
#include "solid.glsl"

layout(location = 0) rayPayloadInEXT SolidHit seen;
// The part and the face that the ray goes through.
hitAttributeEXT uvec2 crossed;

// The hit again, from the face and not from the ray, in the solid's own space: its point, the normal of
// the face, and by how much, in units of ROUNDING, the next ray may find it on the wrong side.
//
// Plane: brought onto it, the point is off by the rounding of the last sum, |p|. The next ray's height
// is a sum of products with the distances to the anchor, or from the origin: 4 roundings of those.
// Ball: as in shape.rchit of chapter 08, 46 roundings of the radius.
vec3 point_of_face(Face face, out vec3 normal, out vec3 error_bound) {
    precise vec3 p = gl_ObjectRayOriginEXT + gl_HitTEXT * gl_ObjectRayDirectionEXT;
    if (face.kind == FACE_BALL) {
        Ball ball = push.solids.balls.at[face.index];
        normal = normalize(p - ball.center);
        precise vec3 point = ball.center + ball.radius * normal;
        error_bound = abs(point) + vec3(46.0 * ball.radius);
        return point;
    }
    Plane plane = push.solids.planes.at[face.index];
    precise float off = height_below(plane, p) / dot(plane.normal, plane.normal);
    precise vec3 point = p + off * plane.normal;
    normal = normalize(plane.normal);
    error_bound = 6.0 * abs(point) + 4.0 * abs(plane.anchor);
    return point;
}

// From there to the world, as for triangles (common/ray_offset.glsl).
HitPoint hit_point_on_face(Face face) {
    vec3 normal;
    vec3 own;
    vec3 point = point_of_face(face, normal, own);
    precise vec3 world = vec3(gl_ObjectToWorldEXT * vec4(point, 1.0));

    mat3 linear = absolute(mat3(gl_ObjectToWorldEXT));
    mat3 inverse = absolute(mat3(gl_WorldToObjectEXT));
    vec3 shift = abs(gl_ObjectToWorldEXT[3]);
    vec3 reach = linear * abs(point);
    vec3 error_bound = linear * own + 4.0 * (reach + shift) + abs(world)
        + linear * (inverse * (18.0 * reach + 7.0 * (abs(world) + shift)));

    HitPoint at;
    at.position = world;
    // Out of the solid, whichever part has the face: against a ray that comes in, along one that goes
    // out. And that is the side seen, turned to the eye.
    at.face = normalize(vec3(normal * gl_WorldToObjectEXT));
    at.face = faceforward(at.face, gl_WorldRayDirectionEXT, at.face);
    at.offset = ROUNDING * dot(abs(at.face), error_bound);
    return at;
}

// The nearest hit is a solid: the intersection shader has left its part and face.
void main() {
    SolidRecord solid = push.solids.at.at[gl_InstanceCustomIndexEXT - push.solids.first];
    Part part = push.solids.parts.at[solid.first_part + crossed.x];
    Face face = push.solids.faces.at[crossed.y];
    HitPoint at = hit_point_on_face(face);
    Hit hit;
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    hit.normal = hit.face;
    hit.color = push.scene.materials.at[part.material].base_color;
    hit.material = part.material;
    // The place of the face among those of its solid.
    hit.triangle = crossed.y - push.solids.parts.at[solid.first_part].first_face;
    hit.instance = gl_InstanceCustomIndexEXT;
    seen = SolidHit(hit, gl_HitKindEXT);
}
