// A ray against an algebraic surface: the points of a closed box where a polynomial of degree four in x, y and z is 0. If
// the coefficients of all terms of degree four are 0, it is a cubic, or of a lower degree.
//
// Along a ray it is a polynomial in t. A touch counts once, and a ray along which the polynomial is 0 has no hit. `precise`:
// rounding is what this is about, so no compiler may rearrange it.
#include "common/quartic.glsl"
#include "common/brackets.glsl"
#include "ferrari.glsl"

const uint ALGEBRAIC_FERRARI = 0;
const uint ALGEBRAIC_POLISHED = 1;
const uint ALGEBRAIC_BRACKETED = 2;

// The 35 coefficients stay in memory, from `first`, in POV-Ray's order: x⁴, x³y, x³z, x³, x²y², …, z, 1.
struct Algebraic {
    vec3 low;
    vec3 high;
    Numbers numbers;
    uint first;
};

struct AlgebraicHits {
    uint count;
    float t;   // of the first
};

void algebraic_meet(inout AlgebraicHits hits, float t, float tmin, float tmax) {
    if (t > tmin && t <= tmax) {
        hits.t = hits.count == 0 ? t : min(hits.t, t);
        hits.count++;
    }
}

// The first and the last t of a line's way through the closed box.
bool algebraic_span(Algebraic a, vec3 o, vec3 d, out vec2 span) {
    span = vec2(-1e38, 1e38);
    for (int k = 0; k < 3; k++) {
        if (d[k] == 0.0) {
            if (o[k] < a.low[k] || o[k] > a.high[k]) {
                return false;
            }
            continue;
        }
        precise vec2 faces = vec2(a.low[k] - o[k], a.high[k] - o[k]) / d[k];
        span = vec2(max(span.x, min(faces.x, faces.y)), min(span.y, max(faces.x, faces.y)));
    }
    return span.x <= span.y;
}

// ANCHOR: along
// q·(o + d·t), where q has a lower degree than `degree`.
Quartic quartic_times(Quartic q, float o, float d, int degree) {
    for (int m = 4; m > 0; m--) {
        if (m <= degree) {
            precise float c = q.c[m] * o + q.c[m - 1] * d;
            q.c[m] = c;
        }
    }
    precise float c = q.c[0] * o;
    q.c[0] = c;
    return q;
}

Quartic quartic_plus(Quartic a, Quartic b) {
    for (int m = 0; m < 5; m++) {
        precise float c = a.c[m] + b.c[m];
        a.c[m] = c;
    }
    return a;
}

// By Horner's rule, first in z, then in y, then in x: POV-Ray's order fits it. With `is_absolute`, all coefficients count as
// positive.
Quartic algebraic_along(Algebraic a, vec3 o, vec3 d, bool is_absolute) {
    const Quartic zero = Quartic(float[5](0.0, 0.0, 0.0, 0.0, 0.0));
    Quartic of_x = zero;
    uint n = a.first;
    for (int i = 0; i <= 4; i++) {
        Quartic of_y = zero;
        for (int j = 0; j <= i; j++) {
            Quartic of_z = zero;
            for (int k = 0; k <= j; k++) {
                of_z = quartic_times(of_z, o.z, d.z, k);
                float c = a.numbers.at[n++];
                of_z.c[0] += is_absolute ? abs(c) : c;
            }
            of_y = quartic_plus(quartic_times(of_y, o.y, d.y, j), of_z);
        }
        of_x = quartic_plus(quartic_times(of_x, o.x, d.x, i), of_y);
    }
    return of_x;
}
// ANCHOR_END: along

vec3 algebraic_gradient(Algebraic a, vec3 p) {
    // Derivatives by x, y and z, and the value.
    vec4 of_x = vec4(0.0);
    uint n = a.first;
    for (int i = 0; i <= 4; i++) {
        vec4 of_y = vec4(0.0);
        for (int j = 0; j <= i; j++) {
            vec4 of_z = vec4(0.0);
            for (int k = 0; k <= j; k++) {
                of_z = of_z * p.z + vec4(0.0, 0.0, of_z.w, a.numbers.at[n++]);
            }
            of_y = of_y * p.y + vec4(0.0, of_y.w, 0.0, 0.0) + of_z;
        }
        of_x = of_x * p.x + vec4(of_x.w, 0.0, 0.0, 0.0) + of_y;
    }
    return of_x.xyz;
}

// As published: from the ray's own origin, and by the closed form.
AlgebraicHits algebraic_ferrari(Algebraic a, vec3 o, vec3 d, float tmin, float tmax) {
    AlgebraicHits hits = AlgebraicHits(0, 0.0);
    vec2 span;
    if (!algebraic_span(a, o, d, span)) {
        return hits;
    }
    float roots[4];
    int count = quartic_roots(algebraic_along(a, o, d, false), 0.0, roots);
    for (int i = 0; i < count; i++) {
        if (roots[i] >= span.x && roots[i] <= span.y) {
            algebraic_meet(hits, roots[i], tmin, tmax);
        }
    }
    return hits;
}

// The same line from the point nearest to the middle of the box, with a direction of length one.
struct AlgebraicLine {
    vec3 o;
    vec3 d;
    float t;       // the ray's t there
    float unit;    // t changes by this per unit of length
    vec2 span;     // the way through the box from there
};

bool algebraic_line(Algebraic a, vec3 o, vec3 d, out AlgebraicLine line) {
    precise vec3 middle = 0.5 * a.low + 0.5 * a.high;
    precise float dd = dot(d, d);
    precise float t = dot(middle - o, d) / dd;
    precise vec3 p = o + t * d;
    // The second step removes the rounding error of the first.
    precise float rest = dot(middle - p, d) / dd;
    p += rest * d;
    t += rest;
    precise float speed = sqrt(dd);
    line = AlgebraicLine(p, d / speed, t, 1.0 / speed, vec2(0.0));
    return algebraic_span(a, line.o, line.d, line.span);
}

// The closed form from near the box, where a very small leading coefficient counts as 0, and two of Newton's steps for each
// root.
AlgebraicHits algebraic_polished(Algebraic a, vec3 o, vec3 d, float tmin, float tmax) {
    AlgebraicHits hits = AlgebraicHits(0, 0.0);
    AlgebraicLine line;
    if (!algebraic_line(a, o, d, line)) {
        return hits;
    }
    Quartic q = algebraic_along(a, line.o, line.d, false);
    Quartic slope = derivative(q);
    float largest = max(max(abs(q.c[0]), abs(q.c[1])), max(max(abs(q.c[2]), abs(q.c[3])), abs(q.c[4])));
    float roots[4];
    int count = quartic_roots(q, 1e-6 * largest, roots);
    for (int i = 0; i < count; i++) {
        precise float x = roots[i];
        for (int n = 0; n < 2; n++) {
            float rise = value(slope, x);
            x -= rise != 0.0 ? value(q, x) / rise : 0.0;
        }
        if (x >= line.span.x && x <= line.span.y) {
            precise float t = line.t + x * line.unit;
            algebraic_meet(hits, t, tmin, tmax);
        }
    }
    return hits;
}

// ANCHOR: bracketed
// Between the places where its derivative is 0 the polynomial rises or falls, so a change of sign is one root. The
// derivative's own roots are found in the same way.
AlgebraicHits algebraic_bracketed(Algebraic a, vec3 o, vec3 d, float tmin, float tmax) {
    AlgebraicHits hits = AlgebraicHits(0, 0.0);
    AlgebraicLine line;
    if (!algebraic_line(a, o, d, line)) {
        return hits;
    }
    Quartic q = algebraic_along(a, line.o, line.d, false);
    if (q.c == float[5](0.0, 0.0, 0.0, 0.0, 0.0)) {
        return hits;
    }
    Quartic slope = derivative(q);
    Quartic bend = derivative(slope);
    float low = line.span.x;
    float high = line.span.y;
    float ends[5] = float[5](low, high, high, high, high);
    int count = 2;
    // The places without a bend: by the quotient that loses no digits, and by the other if there are two.
    precise float discriminant = 0.25 * bend.c[1] * bend.c[1] - bend.c[0] * bend.c[2];
    if (discriminant > 0.0) {
        precise float s = bend.c[1] > 0.0 ? -0.5 * bend.c[1] - sqrt(discriminant) : sqrt(discriminant) - 0.5 * bend.c[1];
        float near = clamp(bend.c[0] / s, low, high);
        float far = bend.c[2] != 0.0 ? clamp(s / bend.c[2], low, high) : near;
        ends = float[5](low, min(near, far), max(near, far), high, high);
        count = 4;
    }
    replace_by_roots(slope, ends, count);
    float before = value(q, low);
    if (before == 0.0) {
        algebraic_meet(hits, line.t + low * line.unit, tmin, tmax);
    }
    for (int i = 1; i < count; i++) {
        float after = value(q, ends[i]);
        float x = ends[i];
        if (before > 0.0 && after < 0.0 || before < 0.0 && after > 0.0) {
            x = root_between(q, slope, ends[i - 1], ends[i]);
        }
        if (after == 0.0 || x != ends[i]) {
            precise float t = line.t + x * line.unit;
            algebraic_meet(hits, t, tmin, tmax);
        }
        before = after;
    }
    return hits;
}
// ANCHOR_END: bracketed
