// A ray against an algebraic surface in two-floats: the roots of every derivative cut the way through the box into pieces with
// at most one root. After algebraic.glsl, and two_float.glsl's sums and products, which say what they need.
#include "common/two_float.glsl"

const uint ALGEBRAIC_TWO_FLOAT = 3;

struct QuarticTwoFloat {
    vec2 c[5];
};

vec2 quartic_at(QuarticTwoFloat q, vec2 t) {
    vec2 sum = q.c[4];
    for (int m = 3; m >= 0; m--) {
        sum = ff_add(ff_mul(sum, t), q.c[m]);
    }
    return sum;
}

QuarticTwoFloat quartic_times(QuarticTwoFloat q, vec2 o, float d, int degree) {
    for (int m = 4; m > 0; m--) {
        if (m <= degree) {
            q.c[m] = ff_add(ff_mul(q.c[m], o), ff_mul(q.c[m - 1], d));
        }
    }
    q.c[0] = ff_mul(q.c[0], o);
    return q;
}

QuarticTwoFloat quartic_plus(QuarticTwoFloat a, QuarticTwoFloat b, int degree) {
    for (int m = 0; m < 5; m++) {
        if (m <= degree) {
            a.c[m] = ff_add(a.c[m], b.c[m]);
        }
    }
    return a;
}

// Coefficients for lengths in units of 2^size, times 2^-scale.
QuarticTwoFloat algebraic_along(Algebraic a, vec2 o[3], vec3 d, int size, int scale) {
    const QuarticTwoFloat zero = QuarticTwoFloat(vec2[5](vec2(0.0), vec2(0.0), vec2(0.0), vec2(0.0), vec2(0.0)));
    QuarticTwoFloat of_x = zero;
    uint n = a.first;
    for (int i = 0; i <= 4; i++) {
        QuarticTwoFloat of_y = zero;
        for (int j = 0; j <= i; j++) {
            QuarticTwoFloat of_z = zero;
            for (int k = 0; k <= j; k++) {
                of_z = quartic_times(of_z, o[2], d.z, k);
                of_z.c[0] = ff_add(of_z.c[0], vec2(scaled(a.numbers.at[n++], size * (4 - k) - scale), 0.0));
            }
            of_y = quartic_plus(quartic_times(of_y, o[1], d.y, j), of_z, j);
        }
        of_x = quartic_plus(quartic_times(of_x, o[0], d.x, i), of_y, i);
    }
    return of_x;
}

// A derivative divided by a factorial: level 1 has degree one, and level 4 is the polynomial itself.
QuarticTwoFloat algebraic_level(QuarticTwoFloat q, int level) {
    const vec2 zero = vec2(0.0);
    if (level == 1) {
        return QuarticTwoFloat(vec2[5](q.c[3], 4.0 * q.c[4], zero, zero, zero));
    }
    if (level == 2) {
        return QuarticTwoFloat(vec2[5](q.c[2], ff_mul(q.c[3], 3.0), ff_mul(q.c[4], 6.0), zero, zero));
    }
    if (level == 3) {
        return QuarticTwoFloat(vec2[5](q.c[1], 2.0 * q.c[2], ff_mul(q.c[3], 3.0), 4.0 * q.c[4], zero));
    }
    return q;
}

// A number's sign as -1, 0 or 1, where one of at most `least` is 0.
int sign_beyond(float least, vec2 a) {
    return a.x > least ? 1 : a.x < -least ? -1 : 0;
}

// Newton's steps, and half of the interval where they leave it.
vec2 quartic_root(QuarticTwoFloat q, vec2 low, vec2 high, int sign_at_low) {
    vec2 t = 0.5 * ff_add(low, high);
    for (int i = 0; i < 64; i++) {
        vec2 value = quartic_at(q, t);
        if (value.x == 0.0) {
            break;
        }
        if (sign_beyond(0.0, value) == sign_at_low) {
            low = t;
        } else {
            high = t;
        }
        precise float slope =
            ((4.0 * q.c[4].x * t.x + 3.0 * q.c[3].x) * t.x + 2.0 * q.c[2].x) * t.x + q.c[1].x;
        precise float change = slope != 0.0 ? -value.x / slope : 1e30;
        vec2 next = ff_add(t, vec2(change, 0.0));
        if (!ff_less(low, next) || !ff_less(next, high)) {
            next = 0.5 * ff_add(low, high);
            change = ff_sub(next, t).x;
        }
        t = next;
        if (abs(change) < 1e-14) {
            break;
        }
    }
    return t;
}

// ANCHOR: algebraic
void algebraic_two_float(Algebraic a, vec3 o, vec3 d, float tmin, float tmax, out AlgebraicHits hits) {
    hits = AlgebraicHits(0, 0.0);
    // Scaled by powers of two, so that no edge of the box is longer than about 1, nor is the direction.
    int speed = exponent_of(d);
    d = scaled(d, -speed);
    int size = exponent_of(a.high - a.low);
    a.low = scaled(a.low, -size);
    a.high = scaled(a.high, -size);
    o = scaled(o, -size);
    // A whole number, so that no product with d rounds.
    precise float foot = dot(0.5 * a.low + 0.5 * a.high - o, d) / dot(d, d);
    precise float start = floor(foot + 0.5);
    vec2 there[3];
    vec2 enter = vec2(-1e30, 0.0);
    vec2 leave = vec2(1e30, 0.0);
    for (int k = 0; k < 3; k++) {
        vec3 sum = vec3(o[k], 0.0, 0.0);
        sum_add_product(sum, start, d[k]);
        there[k] = sum_total(sum);
        vec2 to_low = ff_sub(vec2(a.low[k], 0.0), there[k]);
        vec2 to_high = ff_sub(vec2(a.high[k], 0.0), there[k]);
        if (d[k] == 0.0) {
            if (to_low.x > 0.0 || to_high.x < 0.0) {
                return;
            }
            continue;
        }
        bool rises = d[k] > 0.0;
        vec2 first = ff_div(rises ? to_low : to_high, vec2(d[k], 0.0));
        vec2 last = ff_div(rises ? to_high : to_low, vec2(d[k], 0.0));
        enter = ff_less(enter, first) ? first : enter;
        leave = ff_less(last, leave) ? last : leave;
    }
    // A hit at tmin does not count, one at tmax does.
    vec2 first_t = ff_sub(vec2(scaled(tmin, speed - size), 0.0), vec2(start, 0.0));
    float last = scaled(tmax, speed - size);
    vec2 last_t = last < 1e30 ? ff_sub(vec2(last, 0.0), vec2(start, 0.0)) : leave;
    bool has_first = ff_less(first_t, enter);
    enter = has_first ? enter : first_t;
    leave = ff_less(last_t, leave) ? last_t : leave;
    if (ff_less(leave, enter)) {
        return;
    }
    // The same polynomial where every number counts as positive: at t it says how much cancels, and so how large the error of
    // rounding may be.
    vec3 near = scaled(abs(vec3(there[0].x, there[1].x, there[2].x)), size);
    Quartic bound = algebraic_along(a, near, scaled(abs(d), size), true);
    float largest = max(max(bound.c[0], bound.c[1]), max(max(bound.c[2], bound.c[3]), bound.c[4]));
    if (largest == 0.0) {
        return;
    }
    int scale = exponent_of(largest);
    for (int m = 0; m < 5; m++) {
        bound.c[m] = scaled(bound.c[m], -scale - 46);
    }
    QuarticTwoFloat q = algebraic_along(a, there, d, size, scale);
    if (q.c[0].x == 0.0 && q.c[1].x == 0.0 && q.c[2].x == 0.0 && q.c[3].x == 0.0 && q.c[4].x == 0.0) {
        return;
    }
    // The third derivative's root is at 4, those of the second at 2 and 6, those of the first at 1, 3, 5 and 7: at most one
    // in each piece. Where there is none, the place is the one before it.
    vec2 places[9] = vec2[9](enter, enter, enter, enter, enter, enter, enter, enter, leave);
    int levels[9] = int[9](0, 0, 0, 0, 0, 0, 0, 0, 0);
    for (int level = 1; level < 4; level++) {
        QuarticTwoFloat derived = algebraic_level(q, level);
        int stride = 8 >> level;
        int before = sign_beyond(0.0, quartic_at(derived, enter));
        for (int n = stride; n < 8; n += 2 * stride) {
            vec2 low = places[n - stride];
            vec2 high = places[n + stride];
            int after = low == high ? before : sign_beyond(0.0, quartic_at(derived, high));
            bool is_there = before * after < 0;
            places[n] = is_there ? quartic_root(derived, low, high, before) : low;
            levels[n] = is_there ? 4 - level : 0;
            before = after;
        }
    }
    // Neighbouring places where the value is 0 are one root; if it is 0 at all places, the ray lies in the surface. The higher
    // the derivative whose root a place is, the less does rounding move it if it is a multiple root.
    int before = 0;
    int touched = -1;
    bool is_first = false;
    for (int n = 0; n <= 8; n++) {
        if (n > 0 && places[n] == places[n - 1]) {
            continue;
        }
        int after = sign_beyond(value(bound, abs(places[n].x)), quartic_at(q, places[n]));
        bool is_last = places[n] == leave;
        if (after == 0) {
            is_first = touched < 0 ? n == 0 : is_first;
            touched = touched < 0 || levels[n] > levels[touched] ? n : touched;
        }
        bool lies_within = after == 0 && n > 0 && is_first;
        bool ends = touched >= 0 && (after != 0 || is_last && !lies_within) && (has_first || !is_first);
        bool crosses = touched < 0 && before * after < 0;
        if (crosses || ends) {
            vec2 low = places[max(n - 1, 0)];
            vec2 t = crosses ? quartic_root(q, low, places[n], before) : places[touched];
            hits.t = hits.count == 0 ? scaled(ff_add(vec2(start, 0.0), t), size - speed).x : hits.t;
            hits.count++;
        }
        touched = after != 0 ? -1 : touched;
        before = after;
    }
}
// ANCHOR_END: algebraic
