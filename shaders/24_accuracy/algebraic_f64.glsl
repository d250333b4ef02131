// A ray against an algebraic surface in 64 bits, for devices that have them: algebraic_two_float() with doubles.

const uint ALGEBRAIC_FLOAT64 = 4;

struct QuarticFloat64 {
    double c[5];
};

double quartic_at(QuarticFloat64 q, double t) {
    precise double sum = q.c[4];
    for (int m = 3; m >= 0; m--) {
        sum = sum * t + q.c[m];
    }
    return sum;
}

QuarticFloat64 quartic_times(QuarticFloat64 q, double o, double d, int degree) {
    for (int m = 4; m > 0; m--) {
        if (m <= degree) {
            precise double c = q.c[m] * o + q.c[m - 1] * d;
            q.c[m] = c;
        }
    }
    precise double c = q.c[0] * o;
    q.c[0] = c;
    return q;
}

QuarticFloat64 quartic_plus(QuarticFloat64 a, QuarticFloat64 b) {
    for (int m = 0; m < 5; m++) {
        precise double c = a.c[m] + b.c[m];
        a.c[m] = c;
    }
    return a;
}

// With `is_absolute`, all coefficients count as positive.
QuarticFloat64 algebraic_along(Algebraic a, dvec3 o, dvec3 d, bool is_absolute) {
    const QuarticFloat64 zero = QuarticFloat64(double[5](0.0LF, 0.0LF, 0.0LF, 0.0LF, 0.0LF));
    QuarticFloat64 of_x = zero;
    uint n = a.first;
    for (int i = 0; i <= 4; i++) {
        QuarticFloat64 of_y = zero;
        for (int j = 0; j <= i; j++) {
            QuarticFloat64 of_z = zero;
            for (int k = 0; k <= j; k++) {
                of_z = quartic_times(of_z, o.z, d.z, k);
                float c = a.numbers.at[n++];
                of_z.c[0] += double(is_absolute ? abs(c) : c);
            }
            of_y = quartic_plus(quartic_times(of_y, o.y, d.y, j), of_z);
        }
        of_x = quartic_plus(quartic_times(of_x, o.x, d.x, i), of_y);
    }
    return of_x;
}

QuarticFloat64 algebraic_level(QuarticFloat64 q, int level) {
    if (level == 1) {
        return QuarticFloat64(double[5](q.c[3], 4.0LF * q.c[4], 0.0LF, 0.0LF, 0.0LF));
    }
    if (level == 2) {
        return QuarticFloat64(double[5](q.c[2], 3.0LF * q.c[3], 6.0LF * q.c[4], 0.0LF, 0.0LF));
    }
    if (level == 3) {
        return QuarticFloat64(double[5](q.c[1], 2.0LF * q.c[2], 3.0LF * q.c[3], 4.0LF * q.c[4], 0.0LF));
    }
    return q;
}

int sign_beyond(double least, double a) {
    return a > least ? 1 : a < -least ? -1 : 0;
}

double quartic_root(QuarticFloat64 q, double low, double high, int sign_at_low) {
    double t = 0.5LF * (low + high);
    double least = 1e-16LF * max(abs(low), abs(high));
    for (int i = 0; i < 64; i++) {
        double value = quartic_at(q, t);
        if (value == 0.0LF) {
            break;
        }
        if (sign_beyond(0.0LF, value) == sign_at_low) {
            low = t;
        } else {
            high = t;
        }
        precise double slope = ((4.0LF * q.c[4] * t + 3.0LF * q.c[3]) * t + 2.0LF * q.c[2]) * t + q.c[1];
        precise double next = slope != 0.0LF ? t - value / slope : low;
        next = next > low && next < high ? next : 0.5LF * (low + high);
        double change = abs(next - t);
        t = next;
        if (change <= least) {
            break;
        }
    }
    return t;
}

void algebraic_float64(Algebraic a, vec3 origin, vec3 direction, float tmin, float tmax, out AlgebraicHits hits) {
    hits = AlgebraicHits(0, 0.0);
    dvec3 d = dvec3(direction);
    precise float foot = dot(0.5 * a.low + 0.5 * a.high - origin, direction) / dot(direction, direction);
    double start = double(foot);
    dvec3 there;
    double enter = -1e300LF;
    double leave = 1e300LF;
    for (int k = 0; k < 3; k++) {
        precise double at = double(origin[k]) + start * d[k];
        there[k] = at;
        precise double to_low = double(a.low[k]) - at;
        precise double to_high = double(a.high[k]) - at;
        if (d[k] == 0.0LF) {
            if (to_low > 0.0LF || to_high < 0.0LF) {
                return;
            }
            continue;
        }
        bool rises = d[k] > 0.0LF;
        enter = max(enter, (rises ? to_low : to_high) / d[k]);
        leave = min(leave, (rises ? to_high : to_low) / d[k]);
    }
    precise double first_t = double(tmin) - start;
    precise double last_t = double(tmax) - start;
    bool has_first = first_t < enter;
    enter = max(enter, first_t);
    leave = min(leave, last_t);
    if (leave < enter) {
        return;
    }
    QuarticFloat64 bound = algebraic_along(a, abs(there), abs(d), true);
    QuarticFloat64 q = algebraic_along(a, there, d, false);
    if (q.c[0] == 0.0LF && q.c[1] == 0.0LF && q.c[2] == 0.0LF && q.c[3] == 0.0LF && q.c[4] == 0.0LF) {
        return;
    }
    double places[9] = double[9](enter, enter, enter, enter, enter, enter, enter, enter, leave);
    int levels[9] = int[9](0, 0, 0, 0, 0, 0, 0, 0, 0);
    for (int level = 1; level < 4; level++) {
        QuarticFloat64 derived = algebraic_level(q, level);
        int stride = 8 >> level;
        int before = sign_beyond(0.0LF, quartic_at(derived, enter));
        for (int n = stride; n < 8; n += 2 * stride) {
            double low = places[n - stride];
            double high = places[n + stride];
            int after = low == high ? before : sign_beyond(0.0LF, quartic_at(derived, high));
            bool is_there = before * after < 0;
            places[n] = is_there ? quartic_root(derived, low, high, before) : low;
            levels[n] = is_there ? 4 - level : 0;
            before = after;
        }
    }
    int before = 0;
    int touched = -1;
    bool is_first = false;
    for (int n = 0; n <= 8; n++) {
        if (n > 0 && places[n] == places[n - 1]) {
            continue;
        }
        precise double least = 4.4408920985006262e-16LF * quartic_at(bound, abs(places[n]));
        int after = sign_beyond(least, quartic_at(q, places[n]));
        bool is_last = places[n] == leave;
        if (after == 0) {
            is_first = touched < 0 ? n == 0 : is_first;
            touched = touched < 0 || levels[n] > levels[touched] ? n : touched;
        }
        bool lies_within = after == 0 && n > 0 && is_first;
        bool ends = touched >= 0 && (after != 0 || is_last && !lies_within) && (has_first || !is_first);
        bool crosses = touched < 0 && before * after < 0;
        if (crosses || ends) {
            double x = crosses ? quartic_root(q, places[max(n - 1, 0)], places[n], before) : places[touched];
            precise double t = start + x;
            hits.t = hits.count == 0 ? float(t) : hits.t;
            hits.count++;
        }
        touched = after != 0 ? -1 : touched;
        before = after;
    }
}
