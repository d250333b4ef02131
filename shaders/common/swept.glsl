// Taught by 18_swept_spheres.
//
// A ray against a swept sphere: all balls on the way from one end sphere to the other, their centre and
// radius changing evenly. This is the convex hull of the two end spheres, a cone with round ends.
//
// a, b are the ends' centres and r, q their radii, o is the ray's origin and d its direction, of any length.
// Seen from a, the ball at s, from 0 to 1, has its centre at s·u and the radius r + s·δ,
// where u = b - a and δ = q - r. Which ball is it on whose surface a point p lies, seen from a? With
// k = |u|² - δ², it is the one at s(p) = (p·u + δ·r) / k, taken to 0 or 1 where it lies beyond: there p
// lies on a cap, a part of an end sphere. The body between the caps is k·(|p|² - r²) = (p·u + δ·r)².
// Where k <= 0, one end holds the other, and is all there is.
//
// Each way finds the first root beyond tmin, for the direction as given. swept_textbook() wants lengths whose sixth power is a float, the others
// any between 1e-9 and 1e15.
// `precise`: rounding is what this is about, so no compiler may rearrange it.

const uint SWEPT_TEXTBOOK = 0;
const uint SWEPT_STABLE = 1;
const uint SWEPT_TWO_FLOAT = 2;

// Where a line goes through the surface.
struct Root {
    float t;
    float s;        // of which ball: from 0 at a to 1 at b
    vec3 outward;   // the unit normal, of the surface and not of the axis
};

// The outward normal of the body at a point whose part across the axis is `across`. The body's surface
// leans against the axis, everywhere by the same angle: the sine is δ/|u|, whatever the point.
vec3 body_normal(vec3 across, vec3 u, float delta) {
    precise float uu = dot(u, u);
    float cosine = sqrt(max(uu - delta * delta, 0.0) / uu);
    return cosine * normalize(across) - (delta / uu) * u;
}

// ANCHOR: textbook
// The roots of the quadratic a·t² + 2b·t + c, or of the line 2b·t + c; none where they are not real.
bool roots_textbook(float a, float b, float c, out vec2 t) {
    precise float discriminant = b * b - a * c;
    precise float root = sqrt(max(discriminant, 0.0));
    t = a == 0.0 ? vec2(-0.5 * c / b) : vec2((-b - root) / a, (-b + root) / a);
    return discriminant >= 0.0 && (a != 0.0 || b != 0.0);
}

// Three quadratics, just as written: the body's and those of both ends. A root counts if its point is on
// that part.
bool swept_textbook(vec3 o, vec3 d, vec3 a, vec3 b, float r, float q, float tmin, out Root first) {
    precise vec3 u = b - a;
    precise vec3 f = o - a;
    precise float delta = q - r;
    precise float k = dot(u, u) - delta * delta;
    precise float n = dot(d, u);
    precise float m = dot(f, u) + delta * r;
    const float NONE = 1e38;
    first = Root(NONE, 0.0, vec3(0.0));
    for (int part = 0; part < 3; part++) {
        precise vec3 from = part == 1 ? o - b : f;
        float radius = part == 1 ? q : r;
        precise float qa = part == 2 ? k * dot(d, d) - n * n : dot(d, d);
        precise float qb = part == 2 ? k * dot(f, d) - m * n : dot(from, d);
        precise float qc = part == 2 ? k * (dot(f, f) - r * r) - m * m : dot(from, from) - radius * radius;
        vec2 t;
        if (!roots_textbook(qa, qb, qc, t)) {
            continue;
        }
        for (int i = 0; i < 2; i++) {
            precise float s = k > 0.0 ? (m + t[i] * n) / k : (q > r ? 1.0 : 0.0);
            bool counts = part == 0 ? s <= 0.0 : part == 1 ? s >= 1.0 : k > 0.0 && s > 0.0 && s < 1.0;
            if (counts && t[i] > tmin && t[i] < first.t) {
                precise vec3 p = f + t[i] * d;
                vec3 across = p - (dot(p, u) / dot(u, u)) * u;
                vec3 outward = part == 2 ? body_normal(across, u, delta) : normalize(from + t[i] * d);
                first = Root(t[i], clamp(s, 0.0, 1.0), outward);
            }
        }
    }
    return first.t < NONE;
}
// ANCHOR_END: textbook

// The power of two by which a length becomes one from 1 to 2. A product with it rounds nothing; of a power of
// two it is the inverse.
float unit_of(float size) {
    return intBitsToFloat((254 << 23) - (floatBitsToInt(size) & 0x7f800000));
}

float largest(vec3 v) {
    return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

// ANCHOR: foot
// A line relative to a point: the foot of the perpendicular onto it, and its t. The second step removes the
// rounding error of the first, so that nothing later depends on how far away the ray began.
struct Foot {
    vec3 p;
    float t;
};

Foot foot_of(vec3 f, vec3 d) {
    precise float t = -dot(f, d) / dot(d, d);
    precise vec3 p = f + t * d;
    precise float rest = -dot(p, d) / dot(d, d);
    precise vec3 again = p + rest * d;
    precise float both = t + rest;
    return Foot(again, both);
}

// Half the length of the line within a ball, to either side of its foot; negative if it misses the ball.
float half_chord(Foot foot, vec3 d, float r) {
    precise float size = sqrt(dot(foot.p, foot.p));
    precise float square = (r - size) * (r + size);
    return square >= 0.0 ? sqrt(square / dot(d, d)) : -1.0;
}
// ANCHOR_END: foot

// The end spheres are computed first, from their own centre and radius alone. So two segments that share an
// end compute its sphere alike, to the bit.
bool swept_stable(vec3 o, vec3 d, vec3 a, vec3 b, float r, float q, float tmin, out Root first) {
    float speed = unit_of(largest(d));
    d *= speed;
    Foot at_a = foot_of(o - a, d);
    Foot at_b = foot_of(o - b, d);
    float half_a = half_chord(at_a, d, r);
    float half_b = half_chord(at_b, d, q);

    // From here on in units of the shape's size.
    float unit = unit_of(max(largest(b - a), max(r, q)));
    at_a = Foot(unit * at_a.p, unit * at_a.t);
    at_b = Foot(unit * at_b.p, unit * at_b.t);
    half_a *= unit;
    half_b *= unit;
    r *= unit;
    q *= unit;
    precise vec3 u = unit * (b - a);
    precise float delta = q - r;
    precise float k = dot(u, u) - delta * delta;
    precise float n = dot(d, u);
    precise float dd = dot(d, d);

    // Of all balls, the one that the line passes nearest by, or enters deepest: |p|² - radius² is least. If one
    // end holds the other, it is that end. If the line leans less from the axis than the body does, both ends
    // decide, and the smaller one is nearer to the apex, the only place where two roots of the body meet.
    precise float bend = dot(cross(d, u), cross(d, u)) - delta * delta * dd;
    // It is found from the nearer end, so that near a tip no term is larger than what is left of the radius.
    precise float from_a = (dot(at_a.p, u) + delta * r) * dd / bend;
    precise float from_b = (dot(at_b.p, u) + delta * q) * dd / bend;
    bool by_b = k <= 0.0 ? q > r
        : bend > 0.0 ? from_a > 0.5
        : q < r;
    float off = k > 0.0 && bend > 0.0 ? (by_b ? min(from_b, 0.0) : max(from_a, 0.0)) : 0.0;
    Foot end = by_b ? at_b : at_a;
    Foot mid = end;
    precise float ball = (by_b ? q : r) + off * delta;
    if (off != 0.0) {
        precise vec3 from = end.p - off * u;
        mid = foot_of(from, d);
        precise float t = end.t + mid.t;
        mid.t = t;
    }
    bool met = half_chord(mid, d, ball) >= 0.0;
    if (k > 0.0) {
        met = met || half_a >= 0.0 || half_b >= 0.0;
    }

    // The body, seen from that ball: bend·t² - 2mn·t + c = 0. Where the ball is neither end, m is almost 0,
    // and so the ball alone decides whether there are roots.
    precise float m = dot(mid.p, u) + delta * ball;
    precise float size = sqrt(dot(mid.p, mid.p));
    precise float inside = (ball - size) * (ball + size);
    precise float root = sqrt(max(k * (dd * m * m + bend * inside), 0.0));
    precise float c = -k * inside - m * m;
    precise float mn = m * n;
    // Where the line enters (side -1), and where it leaves.
    for (float side = -1.0; met && side <= 1.0; side += 2.0) {
        // On which part? The surface is an end's where s(p) <= 0, or s(p) >= 1.
        precise float beyond_a = dot(at_a.p, u) + side * half_a * n + delta * r;
        precise float beyond_b = dot(at_b.p, u) + side * half_b * n + delta * q;
        bool is_a = k > 0.0 ? half_a >= 0.0 && beyond_a <= 0.0 : !by_b;
        bool is_b = k > 0.0 ? half_b >= 0.0 && beyond_b >= 0.0 : by_b;
        // Through a tip a line within the cone goes once: it enters the body there, or it leaves.
        is_a = is_a && !(half_a == 0.0 && bend < 0.0 && side * n > 0.0);
        is_b = is_b && !(half_b == 0.0 && bend < 0.0 && side * n < 0.0);
        if (is_a || is_b) {
            Foot own = is_a ? at_a : at_b;
            float way = side * (is_a ? half_a : half_b);
            precise float t = own.t + way;
            first = Root(t, is_a ? 0.0 : 1.0, normalize(own.p + way * d));
        } else {
            // The root whose terms have one sign, and the other from the product of both, c / bend.
            precise float sum = mn + side * root;
            precise float other = mn - side * root;
            float way = side * mn < 0.0 ? c / other : bend != 0.0 ? sum / bend : 0.0;
            precise float t = mid.t + way;
            precise vec3 p = mid.p + way * d;
            precise float along = (by_b ? 1.0 : 0.0) + (off + (dot(p, u) + delta * ball) / k);
            precise vec3 across = p - (dot(p, u) / dot(u, u)) * u;
            first = Root(t, clamp(along, 0.0, 1.0), body_normal(across, u, delta));
        }
        first.t *= speed * unit_of(unit);
        if (first.t > tmin) {
            return true;
        }
    }
    return false;
}
