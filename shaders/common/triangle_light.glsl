// Taught by 29_emitters.
//
// Directions to a triangle: to points that are uniform on it, or uniform in the solid angle that it fills.
#include "common/solid_angle.glsl"

// A triangle whose edges are shorter than this part of its distance is sampled by area. Its height above the point is
// the same everywhere, so that a point's weight goes by the cube of the distance alone, and that differs by less than
// a tenth. A direction, off by some 2^-22, would stray by more than 2^-16 of the width. A small solid angle would be no
// reason: that of a near triangle seen edge on is small too, and its distance differs by any factor.
const float LARGEST_BY_AREA = 1.0 / 64.0;

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

// The solid angle if directions are chosen by it, else 0. A chapter that compares the two ways defines
// `ALL_BY_AREA`: whether points are uniform on every triangle.
float whole_angle(Emitter emitter, vec3 to_corner) {
#ifdef ALL_BY_AREA
    if (ALL_BY_AREA) {
        return 0.0;
    }
#endif
    float longer = max(dot(emitter.across, emitter.across), dot(emitter.along, emitter.along));
    bool is_far = longer < LARGEST_BY_AREA * LARGEST_BY_AREA * dot(to_corner, to_corner);
    return is_far ? 0.0 : solid_angle(to_corner, emitter.across, emitter.along);
}

float angle_of_triangle(Emitter emitter, vec3 from, vec3 to) {
    float whole = whole_angle(emitter, emitter.corner - from);
    return whole > 0.0 ? whole : angle_by_area(emitter, to);
}

Aim aim_at_triangle(Emitter emitter, vec3 from, vec2 u) {
    vec3 to_corner = emitter.corner - from;
    vec3 normal = cross(emitter.across, emitter.along);
    // The side that the point is on.
    normal *= (dot(normal, to_corner) > 0.0 ? -1.0 : 1.0) * inversesqrt(max(dot(normal, normal), 1e-37));
    Aim aim;
    aim.angle = whole_angle(emitter, to_corner);
    if (aim.angle > 0.0) {
        aim.direction = direction_to(to_corner, emitter.across, emitter.along, aim.angle, u);
        // A cosine below 2^-24 is all rounding, and would put the point anywhere along the direction.
        aim.to = dot(to_corner, normal) / min(dot(aim.direction, normal), -6e-8) * aim.direction;
    } else {
        aim.to = point_by_area(emitter, to_corner, u);
        aim.direction = normalize(aim.to);
        aim.angle = angle_by_area(emitter, aim.to);
    }
    aim.to += (emitter.offset + emitter.slack * length(aim.to)) * normal;
    return aim;
}
