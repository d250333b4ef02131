// A ray against a quadric: all points where a polynomial of degree two in x, y and z is 0.
//
// Along the ray o + t·d the polynomial is a·t² + b·t + c. Where the ray is parallel to an asymptote, to a line of a cone
// or to the axis of a paraboloid, a is 0, and there is one root or none. A ray that lies in the surface misses it.
// `precise`: rounding is what this is about, so no compiler may rearrange it.

const uint QUADRIC_TEXTBOOK = 0;
const uint QUADRIC_STABLE = 1;

struct Quadric {
    vec3 square;   // of x², y², z²
    vec3 mixed;    // of yz, xz, xy
    vec3 linear;   // of x, y, z
    float rest;
};

// The derivative of the squares and mixed products in the direction v: linear in both p and v.
float form(Quadric q, vec3 p, vec3 v) {
    precise vec3 gradient = 2.0 * q.square * p + q.mixed.zxy * p.yzx + q.mixed.yzx * p.zxy;
    precise float result = dot(gradient, v);
    return result;
}

vec3 quadric_gradient(Quadric q, vec3 p) {
    precise vec3 gradient = 2.0 * q.square * p + q.mixed.zxy * p.yzx + q.mixed.yzx * p.zxy + q.linear;
    return gradient;
}

// The roots of a·x² + b·x + c in order, and how many there are. Their number is a promise only as good as the discriminant.
struct Roots {
    uint count;
    vec2 at;
};

// From the origin as it is, with the formula from school, which divides by a.
Roots quadric_textbook(Quadric q, vec3 o, vec3 d) {
    precise float a = 0.5 * form(q, d, d);
    precise float b = form(q, o, d) + dot(q.linear, d);
    precise float c = 0.5 * form(q, o, o) + dot(q.linear, o) + q.rest;
    precise float discriminant = b * b - 4.0 * a * c;
    if (a == 0.0 || !(discriminant >= 0.0)) {
        return Roots(0, vec2(0.0));
    }
    precise float root = sqrt(discriminant);
    precise vec2 at = vec2(-b - root, -b + root) / (2.0 * a);
    return Roots(root > 0.0 ? 2 : 1, a > 0.0 ? at : at.yx);
}

// The origin moves to the point of the ray that is nearest to the origin of the coordinates. The root whose terms have
// one sign comes first; the other is a quotient, which remains when a is 0.
Roots quadric_stable(Quadric q, vec3 o, vec3 d) {
    precise float start = -dot(o, d) / dot(d, d);
    precise vec3 p = o + start * d;
    precise float a = 0.5 * form(q, d, d);
    precise float b = dot(quadric_gradient(q, p), d);
    precise float c = 0.5 * form(q, p, p) + dot(q.linear, p) + q.rest;
    precise float discriminant = b * b - 4.0 * a * c;
    if (!(discriminant >= 0.0) || (a == 0.0 && b == 0.0)) {
        return Roots(0, vec2(0.0));
    }
    precise float root = sqrt(discriminant);
    precise float s = b > 0.0 ? -b - root : -b + root;
    precise float small = s != 0.0 ? 2.0 * c / s : 0.0;
    precise float large = a != 0.0 ? s / (2.0 * a) : small;
    if (root == 0.0) {
        small = large;
    }
    precise vec2 at = start + vec2(min(small, large), max(small, large));
    return Roots(a == 0.0 || root == 0.0 ? 1 : 2, at);
}
