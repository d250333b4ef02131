// Taught by 29_emitters.
//
// Directions to a sphere, as likely in each part of the solid angle that it fills.
// ANCHOR: cone
// 1 - cosine of half the cone's opening: the part of the half-sphere that it fills. The cosine of a narrow
// cone is so near to 1 that the difference has no digits; its sine is small and has all of them. Of a wide
// cone it is the cosine that is small: its square is (d - r)(d + r) / d².
float cone(float radius, float distance) {
    float sine = radius / distance;
    float cosine = sqrt((distance - radius) * (distance + radius)) / distance;
    return sine * sine / (1.0 + cosine);
}
// ANCHOR_END: cone

// Two vectors across an axis, and the axis (Duff et al., JCGT 6:1, 2017).
mat3 frame(vec3 axis) {
    float side = axis.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + axis.z);
    float b = axis.x * axis.y * a;
    vec3 right = vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
    vec3 up = vec3(b, side + axis.y * axis.y * a, -axis.y);
    return mat3(right, up, axis);
}

// The solid angle of the sphere as seen from a point; from inside it is all around.
float angle_of_sphere(Emitter emitter, vec3 from) {
    float distance = length(emitter.corner - from);
    return distance > emitter.radius ? 6.283185307 * cone(emitter.radius, distance) : 12.566370614;
}

// From inside every direction meets the sphere: `d` is one, and the centre is at `to_center`.
Aim aim_from_inside(Emitter emitter, vec3 to_center, vec3 d) {
    float middle = dot(to_center, d);
    float distance = length(to_center);
    float apart = (emitter.radius - distance) * (emitter.radius + distance);
    float half_chord = sqrt(max(middle * middle + apart, 0.0));
    float t = middle < 0.0 ? apart / (half_chord - middle) : middle + half_chord;
    vec3 inward = normalize(to_center - t * d);
    return Aim(d, 12.566370614, t * d + (emitter.offset + emitter.slack * t) * inward);
}

Aim aim_at_sphere(Emitter emitter, vec3 from, vec2 u) {
    vec3 to_center = emitter.corner - from;
    float distance = length(to_center);
    float radius = emitter.radius;
    // From -pi to pi: beyond, Vulkan says nothing of a sine's error.
    float turn = 6.283185 * (u.y - 0.5);
    vec2 around = normalize(vec2(cos(turn), sin(turn)));
    if (distance <= radius) {
        float height = 1.0 - 2.0 * u.x;
        return aim_from_inside(emitter, to_center, vec3(2.0 * sqrt(u.x * (1.0 - u.x)) * around, height));
    }
    float whole = cone(radius, distance);
    float w = u.x * whole;                        // 1 - cosine of the angle to the axis
    float sine = sqrt(w * (2.0 - w));
    vec3 axis = to_center / distance;
    vec3 side = frame(axis) * vec3(around, 0.0);
    vec3 direction = (1.0 - w) * axis + sine * side;
    // The ray passes the centre at `aside`; the sphere is half a chord before that.
    float aside = distance * sine;
    float half_chord = sqrt(max((radius - aside) * (radius + aside), 0.0));
    float t = (distance - radius) * (distance + radius) / (distance * (1.0 - w) + half_chord);
    vec3 outward = (aside * ((1.0 - w) * side - sine * axis) - half_chord * direction) / radius;
    vec3 to = t * direction + (emitter.offset + emitter.slack * t) * outward;
    return Aim(direction, 6.283185307 * whole, to);
}
