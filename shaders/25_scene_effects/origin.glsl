// Where a ray starts that leaves a surface: five ways that fail somewhere, and one that does not.
//
// A start below the surface hits it again: acne. A start too far above it is beyond what stands close
// by: leaks. For closest hit shaders, after offset.glsl: that has the hit.
#include "common/start.glsl"
#include "common/origin_rungs.glsl"

// The point that a ray leaves.
struct Departure {
    vec3 position;   // in the world, as the hit has it
    vec3 normal;     // of the triangle, likewise
    vec3 point;      // the position in the mesh's space, where the rest is, too
    vec3 up;         // unit normal there, on the same side
    vec3 to_a;       // from there to the first corner
    vec3 e1;         // from the first corner to the others
    vec3 e2;
};

// ANCHOR: departure
Departure departure(HitPoint hit, InstanceRecord instance, uint triangle, vec2 weights) {
    uvec3 corner = instance.triangles.at[triangle];
    vec3 a = instance.vertices.at[corner.x].position;
    Departure from;
    from.e1 = instance.vertices.at[corner.y].position - a;
    from.e2 = instance.vertices.at[corner.z].position - a;
    precise vec3 within = weights.x * from.e1 + weights.y * from.e2;
    precise vec3 point = a + within;
    from.position = hit.position;
    from.normal = hit.normal;
    from.point = point;
    from.to_a = -within;
    from.up = normalize(cross(from.e1, from.e2));
    from.up = faceforward(from.up, -hit.normal * mat3(gl_ObjectToWorldEXT), from.up);
    return from;
}
// ANCHOR_END: departure

// ANCHOR: naive
// The point that the last ray reached, as it stands. Half of all such points lie below the surface.
Start start_nothing() {
    return Start(gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT, 0.0);
}

// The same, but whatever is near does not count.
Start start_tmin() {
    return Start(start_nothing().origin, 1e-4);
}

// A step up, as long for a grain of sand as for a planet.
Start start_normal(Departure from) {
    return Start(start_nothing().origin + 1e-4 * from.normal, 0.0);
}
// ANCHOR_END: naive

// ANCHOR: integers
Start start_integers(Departure from) {
    return Start(up_by_floats(start_nothing().origin, from.normal), 0.0);
}

// The same from the point in the triangle, which does not get worse with the way the last ray came.
Start start_reprojected(Departure from) {
    return Start(up_by_floats(from.position, from.normal), 0.0);
}
// ANCHOR_END: integers

// ANCHOR: test_error
// How high above the plane of a triangle, in units of ROUNDING, a ray must start lest rounding in
// the triangle test finds it below: for the test of Woop, Benthin and Wald (JCGT 2:1, 2013) and for that
// of Moeller and Trumbore (JGT 2:1, 1997). All in the mesh's space; the page of 26 derives it.
float triangle_test_error(Departure from, vec3 direction) {
    vec3 a = from.to_a, b = a + from.e1, c = a + from.e2;
    float longest = max(max(length(from.e1), length(from.e2)), length(from.e2 - from.e1));
    float area = length(cross(from.e1, from.e2));   // twice the triangle's

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
// ANCHOR_END: test_error

// ANCHOR: bound
// From the point in the triangle, up by no more than rounding may cost. How much the matrices cost is
// not guessed: the point is sent back through the inverse, as the device will send the ray.
Start start_bound(Departure from, vec3 direction) {
    mat3 inverse = mat3(gl_WorldToObjectEXT);
    mat3 sizes = mat3(abs(inverse[0]), abs(inverse[1]), abs(inverse[2]));
    precise vec3 back = gl_WorldToObjectEXT * vec4(from.position, 1.0);
    vec3 rounding = abs(from.point) + 3.0 * (abs(from.e1) + abs(from.e2))
        + 8.0 * (sizes * abs(from.position) + abs(gl_WorldToObjectEXT[3]));
    float error = dot(abs(from.up), rounding) + triangle_test_error(from, inverse * direction);
    float height = max(dot(from.up, from.point - back) + ROUNDING * error, 0.0);

    // A step along the world's normal, and the rounding of the sum.
    float step = height / dot(from.up, inverse * from.normal)
        + ROUNDING * dot(abs(from.normal), abs(from.position));
    return Start(from.position + step * from.normal, 0.0);
}
// ANCHOR_END: bound

// The start by one of the rules above, for a ray in this direction.
Start start_of_ray(uint rule, Departure from, vec3 direction) {
    switch (rule) {
        case ORIGIN_NOTHING: return start_nothing();
        case ORIGIN_TMIN: return start_tmin();
        case ORIGIN_NORMAL: return start_normal(from);
        case ORIGIN_INTEGERS: return start_integers(from);
        case ORIGIN_REPROJECTED: return start_reprojected(from);
        default: return start_bound(from, direction);
    }
}
