// A ray against a sphere in 64 bits, for devices that have them.

const uint SPHERE_FLOAT64 = 7;

// The formulas of sphere_two_float(), with doubles; the first hit with tmin < t <= tmax. Products of two
// floats are exact in doubles, so in f × d, where all that is large cancels, hardly anything rounds.
bool sphere_float64(
    vec3 o, vec3 d, float tmin, float tmax, vec3 center, float r, out float t, out vec3 normal) {
    precise dvec3 f = dvec3(o) - dvec3(center);
    dvec3 e = dvec3(d);
    double square = double(r) * double(r);
    precise double a = dot(e, e);
    precise double b = -dot(f, e);
    precise dvec3 across = cross(f, e);
    precise double discriminant = a * square - dot(across, across);
    t = 0.0;
    normal = vec3(0.0);
    if (a == 0.0LF || r == 0.0 || discriminant < 0.0LF) {
        return false;
    }
    precise double root = sqrt(discriminant);
    precise double c = dot(f, f) - square;
    precise double q = b < 0.0LF ? b - root : b + root;
    // q = 0 is a tangent that begins where it touches; both roots are 0.
    precise double small = q == 0.0LF ? 0.0LF : c / q;
    precise double large = q / a;
    double near = b < 0.0LF ? large : small;
    double far = b < 0.0LF ? small : large;
    bool enters = near > double(tmin) && near <= double(tmax);
    if (!enters && !(far > double(tmin) && far <= double(tmax))) {
        return false;
    }
    // From the foot half a chord along the line: no rounding of t, however far the origin is.
    precise dvec3 outward = cross(e, across) - (enters ? root : -root) * e;
    t = float(enters ? near : far);
    normal = vec3(outward / (a * double(r)));
    return true;
}
