// A ray against a capsule in 64 bits, for devices that have them.

const uint CAPSULE_FLOAT64 = 3;

// One end: sphere_stable() with doubles for floats.
bool end_float64(dvec3 f, dvec3 d, double r, out dvec2 t) {
    precise double a = dot(d, d);
    precise double b = -dot(f, d);
    precise dvec3 foot = f + (b / a) * d;
    precise double discriminant = a * (r * r - dot(foot, foot));
    t = dvec2(0.0LF);
    if (discriminant < 0.0LF) {
        return false;
    }
    precise double c = dot(f, f) - r * r;
    precise double root = sqrt(discriminant);
    precise double q = b < 0.0LF ? b - root : b + root;
    if (q != 0.0LF) {
        precise dvec2 both = dvec2(c / q, q / a);
        t = b < 0.0LF ? both.yx : both;
    }
    return true;
}

// capsule_stable() once more; then the first hit with tmin < t <= tmax.
bool capsule_float64(vec3 o, vec3 direction, float tmin, float tmax, vec3 start, vec3 end, float radius,
    out float t, out vec3 normal) {
    dvec3 d = dvec3(direction);
    double r = double(radius);
    precise dvec3 f = dvec3(o) - dvec3(start);
    precise dvec3 u = dvec3(end) - dvec3(start);
    t = 0.0;
    normal = vec3(0.0);
    precise double dd = dot(d, d);
    if (dd == 0.0LF || r == 0.0LF) {
        return false;
    }
    precise double to_middle = dot(0.5LF * u - f, d) / dd;
    precise dvec3 w = f + to_middle * d;
    precise dvec3 across = cross(d, u);
    precise double a = dot(across, across);
    precise double beside = dot(w, across);
    precise double square = a * (r * r) - beside * beside;
    if (square < 0.0LF) {
        return false;
    }
    precise double uu = dot(u, u);
    precise double ud = dot(u, d);
    precise double b = dot(cross(w, u), across);
    precise double root = sqrt(square * uu);
    for (int k = 0; k < 2; k++) {
        precise double own = a > 0.0LF ? (k == 0 ? -b - root : -b + root) / a : 0.0LF;
        precise double height = dot(u, w) + own * ud;
        if (!(a > 0.0LF)) {
            height = (k == 0) == (ud > 0.0LF) ? -1.0LF : uu + 1.0LF;
        }
        precise dvec3 nearest = clamp(height / uu, 0.0LF, 1.0LF) * u;
        if (!(height > 0.0LF && height < uu)) {
            nearest = height <= 0.0LF ? dvec3(0.0LF) : u;
            dvec2 ends;
            if (!end_float64(w - nearest, d, r, ends)) {
                return false;
            }
            own = k == 0 ? ends.x : ends.y;
        }
        precise double whole = to_middle + own;
        if (whole > double(tmin) && whole <= double(tmax)) {
            precise dvec3 outward = w + own * d - nearest;
            t = float(whole);
            normal = vec3(outward / r);
            return true;
        }
    }
    return false;
}
