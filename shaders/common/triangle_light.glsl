// Taught by 29_emitters.
//
// Directions to a triangle: to points that are uniform on it, or uniform in the solid angle that it fills.
#include "common/solid_angle.glsl"

// ANCHOR: least
// Below this solid angle points are chosen by area. Such a triangle is seen, if it is not long and thin, 1/64
// wide: cosine and distance hardly change on it, so that its area does as well. And a direction, off by some
// 2^-22, would stray from it by more than 2^-16 of its width.
const float LEAST_ANGLE = 1.0 / 4096.0;
// ANCHOR_END: least

// ANCHOR: area
// The solid angle that one point of the triangle stands for, if all are equally likely: area, cosine there,
// distance squared.
float angle_by_area(Emitter emitter, vec3 to) {
    float square = dot(to, to);
    return 0.5 * abs(dot(to, cross(emitter.across, emitter.along))) / (square * sqrt(square));
}

// A point that is uniform on a triangle (Turk, Graphics Gems, 1990).
vec3 point_by_area(Emitter emitter, vec3 to_corner, vec2 u) {
    float root = sqrt(u.x);
    return to_corner + root * ((1.0 - u.y) * emitter.across + u.y * emitter.along);
}
// ANCHOR_END: area

// The solid angle if directions are chosen by it, else 0. A chapter that compares the two ways defines
// `ALL_BY_AREA`: whether points are uniform on every triangle.
float whole_angle(Emitter emitter, vec3 to_corner) {
#ifdef ALL_BY_AREA
    if (ALL_BY_AREA) {
        return 0.0;
    }
#endif
    float angle = solid_angle(to_corner, emitter.across, emitter.along);
    return angle < LEAST_ANGLE ? 0.0 : angle;
}

float angle_of_triangle(Emitter emitter, vec3 from, vec3 to) {
    float whole = whole_angle(emitter, emitter.corner - from);
    return whole > 0.0 ? whole : angle_by_area(emitter, to);
}

// ANCHOR: triangle
Aim aim_at_triangle(Emitter emitter, vec3 from, vec2 u) {
    vec3 to_corner = emitter.corner - from;
    vec3 normal = cross(emitter.across, emitter.along);
    // The side that the point is on.
    normal *= (dot(normal, to_corner) > 0.0 ? -1.0 : 1.0) * inversesqrt(max(dot(normal, normal), 1e-37));
    Aim aim;
    aim.angle = whole_angle(emitter, to_corner);
    if (aim.angle > 0.0) {
        aim.direction = direction_to(to_corner, emitter.across, emitter.along, aim.angle, u);
        aim.to = dot(to_corner, normal) / min(dot(aim.direction, normal), -1e-30) * aim.direction;
    } else {
        aim.to = point_by_area(emitter, to_corner, u);
        aim.direction = normalize(aim.to);
        aim.angle = angle_by_area(emitter, aim.to);
    }
    aim.to += (emitter.height + emitter.slack * length(aim.to)) * normal;
    return aim;
}
// ANCHOR_END: triangle
