// A ray against a cone between two discs in 64 bits, for devices that have them: cone_two_float() with doubles.

const uint CONE_FLOAT64 = 3;

bool cone_float64(vec3 o, vec3 direction, float tmin, float tmax, Cone cone, out Meeting m, out vec3 normal) {
    m = Meeting(0, 0.0, PART_SIDE);
    normal = vec3(0.0);
    if (cone.rb < cone.ra) {
        cone = Cone(cone.b, cone.a, cone.rb, cone.ra, cone.closed);
    }
    dvec3 d = dvec3(direction);
    precise dvec3 f[2] = dvec3[2](dvec3(o) - dvec3(cone.a), dvec3(o) - dvec3(cone.b));
    precise dvec3 u = dvec3(cone.b) - dvec3(cone.a);
    double radius[2] = double[2](double(cone.ra), double(cone.rb));
    precise double uu = dot(u, u);
    precise double ud = dot(u, d);
    precise double k = radius[1] - radius[0];
    precise dvec3 e = cross(d, u);

    double rim[2];
    double at[2];
    double height = 0.0LF;
    double beside = 0.0LF;
    dvec3 foot;
    for (int i = 1; i >= 0; i--) {
        precise dvec3 moment = cross(f[i], d);
        precise dvec3 across = cross(u, moment);
        precise double limit = ud * radius[i];
        precise double square = dot(across, across) - limit * limit;
        precise double up = dot(f[i], u);
        precise double where = -up / (ud == 0.0LF ? 1.0LF : ud);
        precise double aside = dot(u, moment);
        rim[i] = square;
        at[i] = where;
        height = up;
        beside = aside;
        foot = across;
    }
    precise dvec3 v = uu * radius[0] * e - k * cross(foot, u);
    precise double mirrored = uu * beside;
    precise double discriminant = uu * (dot(v, v) - mirrored * mirrored);

    precise double start = dot(0.5LF * u - f[0], d) / dot(d, d);
    precise dvec3 w = f[0] + start * d;
    precise dvec3 across = cross(w, u);
    precise double g = uu * radius[0] + k * dot(w, u);
    precise double rate = k * ud;
    precise double a = uu * dot(e, e) - rate * rate;
    precise double b = uu * dot(across, e) - g * rate;
    precise double c = uu * dot(across, across) - g * g;

    // The chord of the line within the infinite cone.
    bool is_all = a == 0.0LF && discriminant == 0.0LF;
    bool is_chord = a > 0.0LF;
    if (is_all ? rim[0] > 0.0LF : is_chord && discriminant < 0.0LF) {
        return false;
    }
    double root = sqrt(max(discriminant, 0.0LF));
    precise double q = b > 0.0LF ? -b - root : -b + root;
    precise double small = q != 0.0LF ? c / q : 0.0LF;
    precise double large = q / (a != 0.0LF ? a : 1.0LF);
    large = a != 0.0LF ? large : small;
    bool is_point = is_chord && discriminant == 0.0LF;
    small = is_point ? large : small;
    bool is_from = a == 0.0LF ? b < 0.0LF : rate > 0.0LF;
    bool has_first = !is_all && (is_chord || is_from);
    bool has_last = !is_all && (is_chord || !is_from);
    double ends[2] = double[2](min(small, large), max(small, large));
    if (!is_chord) {
        ends = is_from ? double[2](ends[1], ends[1]) : double[2](ends[0], ends[0]);
    }
    precise double middle = -b / (is_chord ? a : 1.0LF);

    bool is_level = ud == 0.0LF;
    int comes = ud > 0.0LF ? 0 : 1;
    double rim_in = is_level ? 1.0LF : rim[comes];
    double rim_out = is_level ? 1.0LF : rim[1 - comes];
    precise double in_at = at[comes] - start;
    precise double out_at = at[1 - comes] - start;
    bool is_past_in = is_level || (has_first && (!has_last || in_at < middle));
    bool is_past_out = !is_level && has_first && (!has_last || out_at < middle);
    if (is_level && (height < 0.0LF || height > uu)) {
        return false;
    }
    if ((rim_in > 0.0LF && !is_past_in) || (rim_out > 0.0LF && is_past_out)) {
        return false;
    }
    bool counts[2];
    bool on_disc[2] = bool[2](false, false);
    bool in_is_last = rim_in == 0.0LF && has_last && (!is_chord || middle < in_at);
    bool out_is_first = rim_out == 0.0LF && has_first && (!is_chord || out_at < middle);
    if (cone.closed) {
        on_disc[0] = rim_in <= 0.0LF;
        on_disc[1] = rim_out <= 0.0LF;
        counts[0] = true;
        counts[1] = !in_is_last && !out_is_first && !is_point;
    } else {
        counts[0] = has_first && (rim_in > 0.0LF || (rim_in == 0.0LF && (!is_chord || in_at <= middle)));
        counts[1] = has_last && (rim_out > 0.0LF || (rim_out == 0.0LF && (!is_chord || out_at >= middle)))
            && !(is_point && counts[0]);
    }
    for (int i = 1; i >= 0; i--) {
        precise double on_side = start + ends[i];
        double t = on_disc[i] ? at[i == 0 ? comes : 1 - comes] : on_side;
        if (!counts[i] || !(t > double(tmin) && t <= double(tmax))) {
            continue;
        }
        m.count++;
        m.t = float(t);
        precise dvec3 out_of = cross(u, across + ends[i] * e);
        precise dvec3 outward = uu * out_of - (g + ends[i] * rate) * k * u;
        bool is_first_disc = (i == 0) == (comes == 0);
        if (on_disc[i] || outward == dvec3(0.0LF)) {
            outward = on_disc[i] && !is_first_disc ? u : -u;
        }
        normal = vec3(outward / sqrt(dot(outward, outward)));
    }
    return m.count > 0;
}
