// A ray against a quadric in 64 bits, for devices that have them: quadric_two_float() with doubles.

const uint QUADRIC_FLOAT64 = 3;

dvec3 gradient_float64(Quadric q, dvec3 p, dvec3 linear) {
    dvec3 mixed = dvec3(q.mixed);
    precise dvec3 gradient = 2.0LF * dvec3(q.square) * p + mixed.zxy * p.yzx + mixed.yzx * p.zxy + linear;
    return gradient;
}

bool quadric_float64(Quadric q, vec3 o, vec3 direction, float tmin, float tmax, out Roots roots, out vec3 normal) {
    roots = Roots(0, vec2(0.0));
    normal = vec3(0.0);
    dvec3 d = dvec3(direction);
    dvec3 linear = dvec3(q.linear);
    // Of few digits, so that no product with d rounds.
    precise float foot = -dot(o, direction) / dot(direction, direction);
    precise double start = double(foot);
    precise dvec3 p = dvec3(o) + start * d;
    precise double twice_a = dot(gradient_float64(q, d, dvec3(0.0LF)), d);
    dvec3 gradient = gradient_float64(q, p, linear);
    precise double b = dot(gradient, d);
    precise double twice_c = dot(gradient, p) + dot(linear, p) + 2.0LF * double(q.rest);
    precise double discriminant = b * b - twice_a * twice_c;
    if (discriminant < 0.0LF || (twice_a == 0.0LF && b == 0.0LF)) {
        return false;
    }
    double root = sqrt(discriminant);
    precise double s = b > 0.0LF ? -b - root : -b + root;
    precise double small = twice_c / (s != 0.0LF ? s : 1.0LF);
    precise double large = s / (twice_a != 0.0LF ? twice_a : 1.0LF);
    large = twice_a != 0.0LF ? large : small;
    small = discriminant == 0.0LF ? large : small;
    bool is_one = twice_a == 0.0LF || discriminant == 0.0LF;
    double x[2] = double[2](min(small, large), max(small, large));
    for (int i = is_one ? 0 : 1; i >= 0; i--) {
        precise double t = start + x[i];
        if (!(t > double(tmin) && t <= double(tmax))) {
            continue;
        }
        roots.count++;
        roots.at.x = float(t);
        precise dvec3 hit = p + x[i] * d;
        dvec3 outward = gradient_float64(q, hit, linear);
        precise double square = dot(outward, outward);
        normal = square > 0.0LF ? vec3(outward / sqrt(square)) : vec3(0.0);
    }
    return roots.count > 0;
}
