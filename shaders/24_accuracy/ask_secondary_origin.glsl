// Where a ray starts that leaves a sphere, and what it meets: kind, center.xyz, radius, point.xyz,
// normal.xyz, direction.xyz, occluder_y. Kind 0: the query's ray finds the point, and the hit is the same
// sphere once more, which should not be. Kind 1: from the point given; the hit is the plane above it.
#include "answer.glsl"
#include "origin_sphere.glsl"
#include "common/sphere.glsl"

// o + t·d, rounded once. Far from the eye, the product's rounding alone would be as long as many steps up.
vec3 point_compensated(vec3 o, float t, vec3 d) {
    vec3 point;
    for (int i = 0; i < 3; i++) {
        vec2 product = two_product(t, d[i]);
        vec2 sum = two_sum(o[i], product.x);
        precise float coordinate = sum.x + (sum.y + product.y);
        point[i] = coordinate;
    }
    return point;
}

Answer ask_secondary_origin(uint rung, Query query, Numbers numbers) {
    uint first = query.first;
    bool is_self = numbers.at[first] == 0.0;
    vec3 direction = vector_at(numbers, first + 11);
    SphereDeparture from;
    from.center = vector_at(numbers, first + 1);
    from.radius = numbers.at[first + 4];
    from.position = vector_at(numbers, first + 5);
    from.normal = vector_at(numbers, first + 8);
    Answer answer = NO_HIT;
    vec2 t;
    bool enters;
    if (is_self) {
        precise vec3 f = query.origin - from.center;
        answer.point = query.origin;
        if (!sphere_stable(f, query.direction, from.radius, t) || !first_root(t, query, enters)) {
            return answer;
        }
        float first_t = enters ? t.x : t.y;
        precise vec3 position = query.origin + first_t * query.direction;
        if (rung == ORIGIN_BOUND) {
            position = point_compensated(query.origin, first_t, query.direction);
        }
        from.position = position;
        from.normal = unit(position - from.center);
    }
    RayOrigin start = start_of_ray(rung, from);
    answer.point = start.origin;
    query.tmin = start.tmin / length(direction);
    query.tmax = 1e30;
    if (is_self) {
        precise vec3 f = start.origin - from.center;
        if (sphere_stable(f, direction, from.radius, t) && first_root(t, query, enters)) {
            answer.hit = 1;
            answer.t = enters ? t.x : t.y;
            answer.normal = unit(f + answer.t * direction);
        }
    } else if (direction.y != 0.0) {
        precise float height = (numbers.at[first + 14] - start.origin.y) / direction.y;
        answer.hit = height > query.tmin ? 1 : 0;
        answer.t = height;
        answer.normal = vec3(0.0, -sign(direction.y), 0.0);
    }
    return answer;
}
