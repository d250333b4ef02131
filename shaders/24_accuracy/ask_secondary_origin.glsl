// Where a ray starts that leaves a sphere, and what it meets: kind, center.xyz, radius, point.xyz,
// normal.xyz, direction.xyz, occluder_y. Kind 0: the query's ray finds the point, and the hit is the same
// sphere once more, which should not be. Kind 1: from the point given; the hit is the plane above it.
#include "answer.glsl"
#include "origin_sphere.glsl"
#include "common/sphere.glsl"

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
        precise vec3 position = query.origin + (enters ? t.x : t.y) * query.direction;
        from.position = position;
        from.normal = unit(position - from.center);
    }
    Start start = start_of_ray(rung, from);
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
