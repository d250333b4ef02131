#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "common/hit_point.glsl"

layout(location = 0) rayPayloadInEXT ShapeHit seen;
hitAttributeEXT vec3 outward;

// The hit, computed from the shape and not along the ray, so that the distance to the ray's origin adds no error;
// and the height above the surface at which the next ray may start.
//
// Sphere, center + r·outward. A unit vector is off by 16u in length (Vulkan allows 9u for the square root and 5u
// for a division), product and sum round: 17u·r + u·|p|. To find both roots behind it, the next ray needs 15u·r
// with the formula of sphere.rint and at most 29u·r with those of common/sphere.glsl: 46u·r in all.
// Box: the wall's own coordinate is the point's, and the next ray's test subtracts it: the sign of a difference is
// never wrong. Then the instance's transform, as for triangles (common/ray_offset.glsl).
HitPoint hit_point_on_shape() {
    precise vec3 point;
    vec3 own;
    if (gl_HitKindEXT == KIND_SPHERE) {
        Sphere sphere = sphere_of(gl_PrimitiveID);
        point = sphere.center + sphere.radius * outward;
        own = abs(point) + vec3(46.0 * sphere.radius);
    } else {
        Box box = box_of(gl_PrimitiveID);
        point = gl_ObjectRayOriginEXT + gl_HitTEXT * gl_ObjectRayDirectionEXT;
        point = mix(point, box.low, lessThan(outward, vec3(0.0)));
        point = mix(point, box.high, greaterThan(outward, vec3(0.0)));
        point = clamp(point, box.low, box.high);
        own = vec3(0.0);
    }
    precise vec3 world = vec3(gl_ObjectToWorldEXT * vec4(point, 1.0));

    mat3 linear = absolute(mat3(gl_ObjectToWorldEXT));
    mat3 inverse = absolute(mat3(gl_WorldToObjectEXT));
    vec3 shift = abs(gl_ObjectToWorldEXT[3]);
    vec3 reach = linear * abs(point);
    vec3 error_bound = linear * own + 4.0 * (reach + shift) + abs(world)
        + linear * (inverse * (18.0 * reach + 7.0 * (abs(world) + shift)));

    HitPoint at;
    at.position = world;
    at.face = normalize(vec3(outward * gl_WorldToObjectEXT));
    at.face = faceforward(at.face, gl_WorldRayDirectionEXT, at.face);
    at.offset = ROUNDING * dot(abs(at.face), error_bound);
    return at;
}

// The nearest hit is a sphere or a box: the intersection shader has left its normal.
void main() {
    bool sphere = gl_HitKindEXT == KIND_SPHERE;
    uint id = sphere ? push.shapes.sphere_ids.at[gl_PrimitiveID]
                     : push.shapes.box_ids.at[gl_PrimitiveID];
    uint material = sphere ? sphere_of(gl_PrimitiveID).material : box_of(gl_PrimitiveID).material;
    HitPoint at = hit_point_on_shape();
    Hit hit;
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    // A shape has one normal.
    hit.normal = hit.face;
    hit.color = push.scene.materials.at[material].base_color;
    hit.material = material;
    hit.triangle = id;
    hit.instance = gl_InstanceCustomIndexEXT;
    uint count = sphere ? push.shapes.sphere_count : push.shapes.box_count;
    seen = ShapeHit(hit, gl_HitKindEXT, float(gl_PrimitiveID) / float(count));
}
