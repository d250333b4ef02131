// Taught by 41_ray_offset.
//
// Where a ray may start that leaves a triangle: a point above it that no rounding puts below.
//
// The hit's own point, origin + t·direction, is off by as much as t is, and t grows with the distance.
// The same point from the triangle's corners is off by the rounding of the corners' coordinates alone.
// (Waechter and Binder, Ray Tracing Gems, chapter 6; NVIDIA's self-intersection avoidance, 2023.)
//
// The distance it may have from the plane that the next ray is tested against: below, u = 2^-24 is the error
// of one rounding, relative; L, T the instance's matrix and translation, W the inverse; |x| takes every
// entry's absolute value. Four things are rounded:
//
// 1. The point in the mesh's space, a + (w1·e1 + w2·e2): three roundings of the edges' part, one of
//    the sum. Wrong barycentrics only shift the point within the plane. u·(|p| + 3·(|e1| + |e2|)), times |L|.
// 2. The point in the world, L·p + T: a sum of four terms. 4u·(|L||p| + |T|); and u·|L·p + T| when the
//    offset is added.
// 3. The next ray, which the device takes back into the mesh's space by an inverse of its own. If that
//    came from cofactors in 32 bits that do not cancel, it is off by 18u·|W|, which costs
//    18u·|L||W||L||p|; product and translation are sums of four terms: 7u·|L||W|·(|world| + |T|).
//    (common/reference/src/transform.rs has the steps, and matrices whose cofactors cancel.)
// 4. The triangle test, which rounds the corners relative to the ray's origin and weighs their depths.
//    For the test of Woop, Benthin and Wald (JCGT 2:1, 2013): 16u·r for the corners and 21u·r for sums and
//    quotient, r the longest edge (common/reference/src/bound.rs has the steps), and for the rounded
//    products of the edge functions 2u·r³/|e1 × e2|. So slivers need more room, but none more than r: the
//    depth that the test finds is a mean of the corners' depths, whatever their weights.
//
// 1 to 3 are vectors, and what counts of them is the part along the plane's normal.

const float ROUNDING = 5.9604645e-8;

mat3 absolute(mat3 m) {
    return mat3(abs(m[0]), abs(m[1]), abs(m[2]));
}

// The part of a hit that says where rays may leave; common/hit.glsl explains its fields.
struct HitPoint {
    vec3 position;
    float offset;
    vec3 face;
};

// Where a ray in direction `ray` meets a triangle of an instance that `to_world` places. What is `const` needs no
// copy, which could cost registers.
HitPoint hit_point(InstanceRecord instance, uint triangle, vec2 barycentrics, const mat4x3 to_world,
        const mat4x3 to_object, const vec3 ray) {
    uvec3 corner = instance.triangles.at[triangle];
    vec3 a = instance.vertices.at[corner.x].position;
    vec3 e1 = instance.vertices.at[corner.y].position - a;
    vec3 e2 = instance.vertices.at[corner.z].position - a;
    precise vec3 point = a + (barycentrics.x * e1 + barycentrics.y * e2);
    precise vec3 world = vec3(to_world * vec4(point, 1.0));

    mat3 linear = absolute(mat3(to_world));
    mat3 inverse = absolute(mat3(to_object));
    vec3 shift = abs(to_world[3]);
    vec3 reach = linear * abs(point);
    vec3 error_bound = linear * (abs(point) + 3.0 * (abs(e1) + abs(e2)))
        + 4.0 * (reach + shift) + abs(world)
        + linear * (inverse * (18.0 * reach + 7.0 * (abs(world) + shift)));

    vec3 across = mat3(to_world) * e1;
    vec3 along = mat3(to_world) * e2;
    float longest = max(max(length(across), length(along)), length(along - across));
    float area = length(cross(across, along));    // twice the triangle's, which may be rounded to 0
    area = max(max(area, 2.0 * ROUNDING * longest * longest), 1e-30);
    float test = longest * (37.0 + 2.0 * longest * longest / area);

    HitPoint at;
    at.position = world;
    vec3 face = vec3(cross(e1, e2) * to_object);
    // Without an area there is no normal: then the side that the ray came from is up.
    at.face = normalize(dot(face, face) > 1e-37 ? face : ray);
    at.face = faceforward(at.face, ray, at.face);
    at.offset = ROUNDING * (dot(abs(at.face), error_bound) + test);
    return at;
}
