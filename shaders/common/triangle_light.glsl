// Taught by 29_emitters.
//
// Directions to a triangle: to points that are uniform on it, or uniform in the solid angle that it fills.
#include "common/solid_angle.glsl"

// ANCHOR: least
// A triangle whose edges are shorter than this part of its distance is sampled by area. Its height above the point is
// the same everywhere, so that a point's weight goes by the cube of the distance alone, and that differs by less than
// a tenth. A direction, off by some 2^-22, would stray by more than 2^-16 of the width. A small solid angle would be no
// reason: that of a near triangle seen edge on is small too, and its distance differs by any factor.
const float LARGEST_BY_AREA = 1.0 / 64.0;
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

// Whether points are uniform on the triangle, or directions in its solid angle. A chapter that compares the two ways
// defines `ALL_BY_AREA`: whether points are uniform on every triangle.
bool is_by_area(Emitter emitter, vec3 to_corner) {
#ifdef ALL_BY_AREA
    if (ALL_BY_AREA) {
        return true;
    }
#endif
    float longer = max(dot(emitter.across, emitter.across), dot(emitter.along, emitter.along));
    return longer < LARGEST_BY_AREA * LARGEST_BY_AREA * dot(to_corner, to_corner);
}

float angle_of_triangle(Emitter emitter, vec3 from, vec3 to) {
    vec3 to_corner = emitter.corner - from;
    return is_by_area(emitter, to_corner)
        ? angle_by_area(emitter, to) : solid_angle(to_corner, emitter.across, emitter.along);
}

// ANCHOR: triangle
Aim aim_at_triangle(Emitter emitter, vec3 from, vec2 u) {
    vec3 to_corner = emitter.corner - from;
    vec3 normal = cross(emitter.across, emitter.along);
    // The side that the point is on.
    normal *= (dot(normal, to_corner) > 0.0 ? -1.0 : 1.0) * inversesqrt(max(dot(normal, normal), 1e-37));
    Aim aim;
    if (is_by_area(emitter, to_corner)) {
        aim.to = point_by_area(emitter, to_corner, u);
        aim.direction = normalize(aim.to);
        aim.angle = angle_by_area(emitter, aim.to);
    } else {
        aim.angle = solid_angle(to_corner, emitter.across, emitter.along);
        if (aim.angle == 0.0) {
            return Aim(-normal, 0.0, to_corner);      // its plane holds the point: no direction leads to it
        }
        aim.direction = direction_to(to_corner, emitter.across, emitter.along, aim.angle, u);
        // Nearly in the plane a rounded direction meets it anywhere, but no farther away than the triangle goes.
        float reach = length(to_corner) + max(length(emitter.across), length(emitter.along));
        float t = dot(to_corner, normal) / min(dot(aim.direction, normal), -1e-30);
        aim.to = min(t, reach) * aim.direction;
    }
    aim.to += (emitter.height + emitter.slack * length(aim.to)) * normal;
    return aim;
}
// ANCHOR_END: triangle
