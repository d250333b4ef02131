// Taught by 29_emitters.
//
// The solid angle of a triangle, and directions that are uniform in it.
//
// `a` leads to the triangle's first corner, `across` and `along` from there to the others: what is small stays
// small, and nothing is a difference of directions that are nearly equal.

// ANCHOR: angle
// An angle from 0 to pi by its cosine and sine, of any length. Vulkan lets atan() be off by 4096 ULP; here
// the angle is halved three times, and five terms of the series are off by 2^-26 of it.
float angle_between(float cosine, float sine) {
    float size = length(vec2(cosine, sine));
    // The tangent of half the angle; beyond a right angle, of half of (pi - angle).
    float z = sine / max(size + abs(cosine), 1e-37);
    z = z / (1.0 + sqrt(1.0 + z * z));
    z = z / (1.0 + sqrt(1.0 + z * z));
    float zz = z * z;
    float eighth = z * (1.0 - zz * (1.0 / 3.0 - zz * (1.0 / 5.0 - zz * (1.0 / 7.0 - zz / 9.0))));
    return cosine < 0.0 ? 3.14159265 - 8.0 * eighth : 8.0 * eighth;
}

// van Oosterom and Strackee, IEEE Transactions on Biomedical Engineering 30:2, 1983.
float solid_angle(vec3 a, vec3 across, vec3 along) {
    vec3 b = a + across, c = a + along;
    float la = length(a), lb = length(b), lc = length(c);
    float volume = abs(dot(a, cross(across, along)));
    float sum = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return 2.0 * angle_between(sum, volume);
}
// ANCHOR_END: angle

// The cosine and sine, of some length, of an angle from 0 to pi: the tangent of a sixteenth by its series,
// and four times the angle is doubled.
vec2 turned(float angle) {
    float z = angle / 16.0;
    float zz = z * z;
    float tangent = z * (1.0 + zz * (1.0 / 3.0 + zz * (2.0 / 15.0 + zz * (17.0 / 315.0 + zz * 62.0 / 2835.0))));
    vec2 t = vec2(1.0, tangent);
    for (uint i = 0; i < 4; i++) {
        t = vec2((t.x - t.y) * (t.x + t.y), 2.0 * t.x * t.y);
    }
    return t;
}

// u.x cuts off, from the corner a, the part u.x of the solid angle `whole`: by a point e on the edge from a to
// c. u.y chooses a point between b and e (Arvo, SIGGRAPH 1995). Where e is, the formula above says, if it is
// asked for a, b and e: in the tangent of half the way from a to e it is linear.
vec3 direction_to(vec3 a, vec3 across, vec3 along, float whole, vec2 u) {
    float la = length(a), lb = length(a + across);
    vec3 to_a = a / la;
    vec3 tangent = normalize(along - dot(along, to_a) * to_a);       // where the edge to c leaves a
    float volume = abs(dot(tangent, cross(to_a, across))) / lb;
    float cosine = dot(to_a, a + across) / lb;
    vec2 part = turned(0.5 * u.x * whole);
    float left = part.x * volume - part.y * dot(across, tangent) / lb;
    float way = part.y * (1.0 + cosine) / max(left, 1e-18);
    vec3 a_to_e = 2.0 * way / (1.0 + way * way) * (tangent - way * to_a);
    // Differences of unit vectors by those of the corners.
    vec3 a_to_b = (across - dot(across, a + a + across) / (la + lb) * to_a) / lb;
    vec3 b_to_e = a_to_e - a_to_b;
    vec3 to_b = (a + across) / lb;
    float square = dot(b_to_e, b_to_e);
    // From b towards e, so far that 1 - cosine is the part u.y of what it is at e.
    float w = 0.5 * u.y * square;
    vec3 on = b_to_e + 0.5 * square * to_b;
    on *= sqrt(w * (2.0 - w)) * inversesqrt(max(dot(on, on), 1e-37));
    return normalize((1.0 - w) * to_b + on);
}
