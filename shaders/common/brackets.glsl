// Taught by 33_roots.
//
// The roots of a polynomial by Newton's method in brackets (C. Yuksel, High-Performance Polynomial Root Finding
// for Graphics, HPG 2022).
//
// Between two neighbouring roots of its derivative a polynomial only rises or only falls, so it has a root there if
// its signs at both ends differ, and no more than one. The derivative's roots are found in the same way, down to a
// quadratic.

// The roots of x² + 2b·x + c, the smaller first; none if they are not real. The one whose terms have the
// same sign loses no digits, and the other follows from the product (Kahan).
bool quadratic(float b, float c, out vec2 roots) {
    precise float discriminant = b * b - c;
    roots = vec2(0.0);
    if (!(discriminant >= 0.0)) {
        return false;
    }
    precise float far = b > 0.0 ? -b - sqrt(discriminant) : -b + sqrt(discriminant);
    float near = far != 0.0 ? c / far : 0.0;
    roots = vec2(min(near, far), max(near, far));
    return true;
}

// A step of Newton's method that would leave the bracket is replaced by the bracket's middle.
const int NEWTON_STEPS = 40;

// ANCHOR: newton
// The place between `low` and `high` where the sign of q changes. It must differ at both; 0 counts as negative.
float root_between(Quartic q, Quartic slope, float low, float high) {
    bool negative_at_low = value(q, low) <= 0.0;
    precise float x = 0.5 * (low + high);
    for (int i = 0; i < NEWTON_STEPS; i++) {
        float y = value(q, x);
        if ((y <= 0.0) == negative_at_low) {
            low = x;
        } else {
            high = x;
        }
        precise float next = x - y / value(slope, x);
        if (!(next > low && next < high)) {
            next = 0.5 * (low + high);
        }
        if (next == x || next == low && next == high) {
            break;
        }
        x = next;
    }
    return x;
}
// ANCHOR_END: newton

// `ends` are the ends of the pieces on which q only rises or falls. Afterwards they are those of its integral:
// both outer ends, and the roots of q.
void replace_by_roots(Quartic q, inout float ends[5], inout int count) {
    Quartic slope = derivative(q);
    float last = ends[count - 1];
    float low = ends[0];
    bool negative = value(q, low) <= 0.0;
    int found = 1;
    for (int i = 1; i < count; i++) {
        float high = ends[i];
        bool then = value(q, high) <= 0.0;
        if (then != negative) {
            ends[found] = root_between(q, slope, low, high);
            found++;
        }
        low = high;
        negative = then;
    }
    ends[found] = last;
    count = found + 1;
}

// ANCHOR: first_root
// The first root of q between `low` and `high`, beyond `above`. Its derivatives have at most 2 and 3 roots.
bool first_root(Quartic q, float low, float high, float above, out float x) {
    Quartic slope = derivative(q);
    Quartic bend = derivative(slope);
    float ends[5] = float[5](low, high, high, high, high);
    int count = 2;
    vec2 flat_places;
    if (quadratic(0.5 * bend.c[1] / bend.c[2], bend.c[0] / bend.c[2], flat_places)) {
        float first = clamp(flat_places.x, low, high);
        float second = clamp(flat_places.y, low, high);
        ends = float[5](low, first, second, high, high);
        count = 4;
    }
    replace_by_roots(slope, ends, count);

    bool negative = value(q, low) <= 0.0;
    for (int i = 1; i < count; i++) {
        bool then = value(q, ends[i]) <= 0.0;
        if (then != negative) {
            x = root_between(q, slope, ends[i - 1], ends[i]);
            if (x > above) {
                return true;
            }
        }
        negative = then;
    }
    x = 0.0;
    return false;
}
// ANCHOR_END: first_root
