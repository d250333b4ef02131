#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "common/hit_point.glsl"

layout(location = 0) rayPayloadInEXT StrandHit seen;
hitAttributeEXT Crossing crossing;

// Where the hit is, and how far above the surface a leaving ray must start.
HitPoint hit_point_on_strand(Node a, Node b) {
    vec3 own;
    float radius;
    vec3 point = strand_point(a, b, crossing, own, radius);
    precise vec3 world = vec3(gl_ObjectToWorldEXT * vec4(point, 1.0));

    mat3 linear = absolute(mat3(gl_ObjectToWorldEXT));
    mat3 inverse = absolute(mat3(gl_WorldToObjectEXT));
    vec3 shift = abs(gl_ObjectToWorldEXT[3]);
    vec3 reach = linear * abs(point);
    vec3 error_bound = linear * own + 4.0 * (reach + shift) + abs(world)
        + linear * (inverse * (18.0 * reach + 7.0 * (abs(world) + shift)));

    HitPoint at;
    at.position = world;
    at.face = normalize(vec3(crossing.outward * gl_WorldToObjectEXT));
    at.face = faceforward(at.face, gl_WorldRayDirectionEXT, at.face);
    at.offset = ROUNDING * dot(abs(at.face), error_bound);
    return at;
}

// The nearest hit is a swept sphere: the intersection shader has left its normal, and where along it.
void main() {
    uint id = push.strands.ids.at[gl_PrimitiveID];
    Segment segment = push.strands.segments.at[id];
    Node a = push.strands.nodes.at[segment.first];
    Node b = push.strands.nodes.at[segment.first + 1];
    HitPoint at = hit_point_on_strand(a, b);
    Hit hit;
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    hit.normal = hit.face;
    if (NORMAL == NORMAL_AXIS) {
        // Wrong: away from the axis, as if the radius did not change and there were no ends. A bead has no axis.
        vec3 axis = b.center - a.center;
        vec3 from = hit.position - a.center;
        vec3 away = normalize(from - dot(from, axis) / max(dot(axis, axis), 1e-30) * axis);
        hit.normal = faceforward(away, gl_WorldRayDirectionEXT, away);
    }
    hit.color = push.scene.materials.at[segment.material].base_color;
    hit.material = segment.material;
    hit.triangle = id;
    hit.instance = gl_InstanceCustomIndexEXT;
    seen = StrandHit(hit, crossing.s);
}
