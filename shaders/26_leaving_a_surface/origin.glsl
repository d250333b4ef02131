// Where a ray starts that leaves a surface, in eight ways: five that fail somewhere, one that does not,
// that of chapter 41 and Mitsuba's.
//
// A ray that starts below the surface hits it again: acne. A ray that starts too far above it misses things
// that are close by: leaks.
#include "common/ray_origin.glsl"

const float ROUNDING = 5.9604645e-8;

struct Ray {
    RayOrigin start;
    vec3 direction;
};

// The point that a ray leaves.
struct Departure {
    vec3 reached;    // where the last ray's t ends
    vec3 position;   // the same in the triangle, by its corners
    vec3 normal;     // of the triangle: unit, on the side that the last ray came from
    float offset;    // chapter 41's
    float sunk;      // how far the way into the world and back puts the position below the triangle
    float error;     // what rounding may hide of that, in units of ROUNDING
    float rise;      // how far a step of 1 along the normal goes up in the mesh's space
    mat3 to_mesh;    // into the mesh's space, where the rest is
    vec3 to_a;       // from the position to the first corner
    vec3 e1;         // from the first corner to the others
    vec3 e2;
};

Departure departure(TriangleHit seen, InstanceRecord instance, Ray arriving) {
    Hit hit = seen.hit;
    uvec3 corner = instance.triangles.at[hit.triangle];
    vec3 a = instance.vertices.at[corner.x].position;
    Departure from;
    from.e1 = instance.vertices.at[corner.y].position - a;
    from.e2 = instance.vertices.at[corner.z].position - a;
    precise vec3 within = seen.barycentrics.x * from.e1 + seen.barycentrics.y * from.e2;
    precise vec3 point = a + within;
    from.reached = arriving.start.origin + hit.t * arriving.direction;
    from.position = hit.position;
    from.normal = hit.face;
    from.offset = hit.offset;
    from.to_mesh = mat3(seen.to_mesh);
    from.to_a = -within;

    // A triangle without an area has no normal except the one that chapter 41 chose.
    vec3 up = cross(from.e1, from.e2);
    up = normalize(dot(up, up) > 1e-37 ? up : from.to_mesh * from.normal);
    // A normal comes into the world by the transposed matrix that takes points out of it.
    up = faceforward(up, -from.normal, up * from.to_mesh);
    mat3 sizes = mat3(abs(from.to_mesh[0]), abs(from.to_mesh[1]), abs(from.to_mesh[2]));
    precise vec3 back = seen.to_mesh * vec4(from.position, 1.0);
    vec3 rounding = abs(point) + 3.0 * (abs(from.e1) + abs(from.e2))
        + 8.0 * (sizes * abs(from.position) + abs(seen.to_mesh[3]));
    from.sunk = dot(up, point - back);
    from.error = dot(abs(up), rounding);
    from.rise = dot(up, from.to_mesh * from.normal);
    return from;
}

// ANCHOR: naive
// The point that the last ray reached, as it stands. Half of all such points lie below the surface.
RayOrigin start_nothing(Departure from) {
    return RayOrigin(from.reached, 0.0);
}

// The same, but whatever is near does not count.
RayOrigin start_tmin(Departure from) {
    return RayOrigin(from.reached, 1e-4);
}

// A step up, as long for a grain of sand as for a planet.
RayOrigin start_normal(Departure from) {
    return RayOrigin(from.reached + 1e-4 * from.normal, 0.0);
}
// ANCHOR_END: naive

#include "common/up_by_floats.glsl"

// ANCHOR: integers
RayOrigin start_integers(Departure from) {
    return RayOrigin(up_by_floats(from.reached, from.normal), 0.0);
}

// The same from the point in the triangle, which does not get worse with the distance of the last ray.
RayOrigin start_reprojected(Departure from) {
    return RayOrigin(up_by_floats(from.position, from.normal), 0.0);
}
// ANCHOR_END: integers

// The height above the plane of a triangle, in units of ROUNDING, at which a ray must start so that no
// rounding in the triangle test puts it below the plane. It holds for the tests of Woop, Benthin and Wald
// (JCGT 2:1, 2013) and of Moeller and Trumbore (JGT 2:1, 1997). All is in the mesh's space; the page
// derives it.
float triangle_test_error(Departure from, vec3 direction) {
    vec3 a = from.to_a, b = a + from.e1, c = a + from.e2;
    float longest = max(max(length(from.e1), length(from.e2)), length(from.e2 - from.e1));
    float area = length(cross(from.e1, from.e2));   // twice the triangle's, which may be rounded to 0
    area = max(max(area, 2.0 * ROUNDING * longest * longest), 1e-30);

    // The axis along which the ray goes farthest becomes z, and the corners slide along the ray to z = 0.
    vec3 size = abs(direction);
    vec3 d = direction;
    if (size.x >= max(size.y, size.z)) {
        a = a.yzx; b = b.yzx; c = c.yzx; d = d.yzx;
    } else if (size.y >= size.z) {
        a = a.zxy; b = b.zxy; c = c.zxy; d = d.zxy;
    }
    vec2 slope = d.xy / d.z;
    vec2 p = abs(a.xy - slope * a.z), q = abs(b.xy - slope * b.z), r = abs(c.xy - slope * c.z);
    float products = (q.x * r.y + q.y * r.x) * abs(a.z) + (r.x * p.y + r.y * p.x) * abs(b.z)
        + (p.x * q.y + p.y * q.x) * abs(c.z);

    // The normal's own error, before it is divided by its length: products that cancel leave it behind.
    vec3 u = abs(from.e1), v = abs(from.e2);
    vec3 normal_error = u.yzx * v.zxy + u.zxy * v.yzx;
    vec3 reach = abs(from.to_a) + longest * size / length(direction);
    return 24.0 * longest + (products + 8.0 * dot(reach, normal_error)) / area;
}

// From the point in the triangle, up by no more than rounding may cost. How much the matrices cost is
// not guessed: the point is sent back through the inverse, as the device will send the ray.
RayOrigin start_bound(Departure from, vec3 direction) {
    float error = from.error + triangle_test_error(from, from.to_mesh * direction);
    float offset = max(from.sunk + ROUNDING * error, 0.0);

    // A step along the world's normal, and the rounding of the sum.
    float step = offset / from.rise + ROUNDING * dot(abs(from.normal), abs(from.position));
    return RayOrigin(from.position + step * from.normal, 0.0);
}

// Chapter 41's: one step for every direction above the surface, so it knows no direction.
RayOrigin start_offset(Departure from) {
    return RayOrigin(from.position + from.offset * from.normal, 0.0);
}

// A vector of the mesh's space in the world, by the inverse of the matrix that goes the other way.
vec3 into_world(mat3 to_mesh, vec3 v) {
    vec3 x = cross(to_mesh[1], to_mesh[2]);
    vec3 y = cross(to_mesh[2], to_mesh[0]);
    vec3 z = cross(to_mesh[0], to_mesh[1]);
    return vec3(dot(x, v), dot(y, v), dot(z, v)) / dot(x, to_mesh[0]);
}

// Up by what enters the position: the largest coordinates of the corners, as seen along the normal. The
// factor was found by trial: one to eight roundings were enough, and 32 leave room (Mitsuba 3, pull request
// 1962, 2026; its meshes lie in the world, so the corners are taken there).
RayOrigin start_magnitudes(Departure from) {
    vec3 a = from.position + into_world(from.to_mesh, from.to_a);
    vec3 b = a + into_world(from.to_mesh, from.e1);
    vec3 c = a + into_world(from.to_mesh, from.e2);
    vec3 largest = max(abs(a), max(abs(b), abs(c)));
    float offset = 32.0 * ROUNDING * dot(abs(from.normal), largest);
    return RayOrigin(from.position + offset * from.normal, 0.0);
}

// The start by the rule that the pipeline is made for, for a ray in this direction.
RayOrigin start_of_ray(Departure from, vec3 direction) {
    switch (ORIGIN) {
        case ORIGIN_NOTHING: return start_nothing(from);
        case ORIGIN_TMIN: return start_tmin(from);
        case ORIGIN_NORMAL: return start_normal(from);
        case ORIGIN_INTEGERS: return start_integers(from);
        case ORIGIN_REPROJECTED: return start_reprojected(from);
        case ORIGIN_OFFSET: return start_offset(from);
        case ORIGIN_MAGNITUDES: return start_magnitudes(from);
        default: return start_bound(from, direction);
    }
}
