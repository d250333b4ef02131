// Where a ray starts that leaves a sphere: 26_leaving_a_surface has the same rules for triangles.
//
// A start below the surface meets it again; a start too far above it is beyond what stands close by.
#include "common/ray_origin.glsl"
#include "common/up_by_floats.glsl"
#include "common/two_float.glsl"

const uint ORIGIN_NOTHING = 0;
const uint ORIGIN_TMIN = 1;
const uint ORIGIN_NORMAL = 2;
const uint ORIGIN_INTEGERS = 3;
const uint ORIGIN_REPROJECTED = 4;
const uint ORIGIN_BOUND = 5;

// The point of a sphere that a ray leaves.
struct SphereDeparture {
    vec3 position;   // as the hit has it: off the sphere by as much as t is off
    vec3 normal;     // unit, on the side where the ray leaves
    vec3 center;
    float radius;
};

// The point as it stands. Half of all such points lie below the surface.
RayOrigin start_nothing(SphereDeparture from) {
    return RayOrigin(from.position, 0.0);
}

// The same, but whatever is near does not count.
RayOrigin start_tmin(SphereDeparture from) {
    return RayOrigin(from.position, 1e-4);
}

// A step up, as long for a grain of sand as for a planet.
RayOrigin start_normal(SphereDeparture from) {
    return RayOrigin(from.position + 1e-4 * from.normal, 0.0);
}

RayOrigin start_integers(SphereDeparture from) {
    return RayOrigin(up_by_floats(from.position, from.normal), 0.0);
}

// The same from the nearest point of the sphere, which does not get worse with the way of the last ray.
RayOrigin start_reprojected(SphereDeparture from) {
    precise vec3 f = from.position - from.center;
    precise vec3 point = from.center + (from.radius / length(f)) * f;
    return RayOrigin(up_by_floats(point, from.normal), 0.0);
}

// The nearest point of the sphere, up by no more than rounding may cost (after Pharr, Jakob and
// Humphreys, Physically Based Rendering, 4th edition, 6.8). Below u = 2^-24 is the error of one rounding,
// relative, f the point as seen from the centre, p in the world, n the normal. An error of e·|f| in every
// coordinate, times the normal's, is one of e·r along the normal.
//
// 1. Brought to the sphere by r / |f|, the point may be off by 19u·r: Vulkan allows 9u for the square root
//    and 5u for the division, and squares, sum and products round, too. That alone would lift every start
//    as high. One step of Newton's method, with r² - |f|² free of rounding, brings it down to 1u·r.
// 2. The step up, in proportion to f: 1u·r. The sum with the centre: u·|n|·|p|.
// 3. The next ray, which takes the centre off again: 1u·r, or nothing if the difference is exact.
// 4. Its test, by sphere_stable(). A ray that leaves is not seen to come back if c > 0: 3u for the
//    squares and their sum, 1u for r², half of that is 2u·r. If the ray grazes, rounding may turn it to
//    the inside; then the foot counts: 2u more for its coordinates, so 3u·r in all.
// 5. A ray that grazes where it should start, and starts aside by u·|p|·sqrt(3), passes lower by the
//    square of that over 2r.
//
// 1 to 4 sum up to 6u·r and u·|n|·|p|; 8u·r has room for what is of higher order.
RayOrigin start_bound(SphereDeparture from) {
    const float ROUNDING = 5.9604645e-8;
    float r = from.radius;
    precise vec3 f = from.position - from.center;
    precise vec3 near = (r / length(f)) * f;
    precise float lack = 0.5 * dot_compensated(two_product(r, r), -near, near) / (r * r);
    precise vec3 point = near + lack * near;

    vec3 world = abs(from.center + point);
    float aside = ROUNDING * length(world);
    float offset = ROUNDING * (8.0 * r + dot(abs(from.normal), world)) + 1.5 * aside * aside / r;
    float side = dot(from.normal, f) < 0.0 ? -1.0 : 1.0;
    precise vec3 above = point + (side * offset / r) * point;
    precise vec3 origin = from.center + above;
    return RayOrigin(origin, 0.0);
}

// The start by one of the rules above.
RayOrigin start_of_ray(uint rule, SphereDeparture from) {
    switch (rule) {
        case ORIGIN_NOTHING: return start_nothing(from);
        case ORIGIN_TMIN: return start_tmin(from);
        case ORIGIN_NORMAL: return start_normal(from);
        case ORIGIN_INTEGERS: return start_integers(from);
        case ORIGIN_REPROJECTED: return start_reprojected(from);
        default: return start_bound(from);
    }
}
