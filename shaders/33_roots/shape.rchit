#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "common/hit.glsl"
#include "common/hit_point.glsl"

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT Frame frame;

// The hit, computed from the shape and not along the ray, so that the distance to the ray's origin adds no error;
// and the height above the surface at which the next ray may start.
//
// The point is centre + R·ring + r·outward. Unit vectors are off by 16u, and by as much again from the axis; products
// and sums round: 40u·(R + r) + 3u·|p|. The next ray's polynomial is at most about 4(R + r)⁴ and off by 16u of that;
// its gradient at the surface is 8·R·r·ρ, where ρ is the distance from the axis, so that moves the surface by
// 8u·(R + r)⁴ / (R·r·ρ). The inner side of a thin hole has a small ρ: no step is larger than a tenth of the tube.
HitPoint hit_point_on_torus(Torus torus) {
    float size = torus.major + torus.minor;
    precise vec3 tube = torus.major * frame.ring;
    precise vec3 local = tube + torus.minor * frame.outward;
    precise vec3 point = torus.center + local;
    float from_axis = max(torus.major + torus.minor * dot(frame.ring, frame.outward), 1e-3 * torus.major);
    float test = 8.0 * (size / torus.major) * (size / torus.minor) * (size / from_axis) * size;

    HitPoint at;
    at.position = point;
    at.face = faceforward(frame.outward, gl_WorldRayDirectionEXT, frame.outward);
    float own = 40.0 * size + dot(abs(at.face), 4.0 * abs(point) + 2.0 * abs(torus.center));
    at.offset = ROUNDING * own + min(ROUNDING * test, 0.1 * torus.minor);
    return at;
}

// The nearest hit is a torus. Its instance does not move it: object and world are one space.
void main() {
    uint id = push.shapes.ids.at[gl_PrimitiveID];
    Torus torus = push.shapes.tori.at[id];
    HitPoint at = hit_point_on_torus(torus);
    hit.position = at.position;
    hit.offset = at.offset;
    hit.face = at.face;
    hit.t = gl_HitTEXT;
    // A shape has one normal.
    hit.normal = hit.face;
    hit.color = push.scene.materials.at[torus.material].base_color;
    hit.material = torus.material;
    hit.triangle = id;
    hit.instance = gl_InstanceCustomIndexEXT;
}
