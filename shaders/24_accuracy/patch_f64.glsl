// A ray against a bilinear patch in 64 bits, for devices that have them: patch_two_float() with doubles.

const uint PATCH_FLOAT64 = 3;

dvec2 patch_root(double first, double middle, double last, double root, double side) {
    if (root == 0.0LF && middle == 0.0LF) {
        return last != 0.0LF ? dvec2(0.0LF, last) : dvec2(first, 0.0LF);
    }
    bool is_sum = (middle >= 0.0LF) == (side < 0.0LF);
    precise double sum = (middle >= 0.0LF ? -root : root) - middle;
    return is_sum ? dvec2(sum, 2.0LF * last) : dvec2(2.0LF * first, sum);
}

bool patch_is_within(dvec2 x) {
    return x != dvec2(0.0LF) && (min(x.x, x.y) >= 0.0LF || max(x.x, x.y) <= 0.0LF);
}

// As in two-floats: true if the line at `x` has no length. Its ends are at `one` and `other` along the ray.
bool patch_is_point(dvec2 x, dvec2 one, dvec2 other, double size) {
    precise double start = abs(x.y) * one.x + abs(x.x) * one.y;
    precise double end = abs(x.y) * other.x + abs(x.x) * other.y;
    precise double most = 9.1e-13LF * size * (abs(x.x) + abs(x.y));    // 2^-40
    return abs(start - end) <= most;
}

double patch_area(dvec2 p, dvec2 q) {
    precise double area = p.x * q.y - p.y * q.x;
    return area;
}

void patch_float64(Patch q, vec3 o, vec3 direction, float tmin, float tmax, out PatchHits hits, out vec3 normal) {
    hits = PatchHits(0, 0.0, vec2(0.0));
    normal = vec3(0.0);
    dvec3 d = dvec3(direction);
    // Of few digits, so that no product with d rounds.
    precise vec3 middle = 0.25 * (q.q00 + q.q10 + q.q01 + q.q11) - o;
    precise float foot = dot(middle, direction) / dot(direction, direction);
    precise dvec3 there = dvec3(o) + double(foot) * d;
    int axis = patch_axis(direction);
    dvec3 ahead = dvec3(patch_turned(direction, axis));
    vec3 corner[4] = vec3[4](q.q00, q.q10, q.q01, q.q11);
    dvec2 seen[4];
    double along[4];
    double highest = 0.0LF;
    for (int n = 0; n < 4; n++) {
        precise dvec3 p = dvec3(corner[n]) - there;
        p = axis == 0 ? p.yzx : axis == 1 ? p.zxy : p;
        precise dvec2 across = p.xy * ahead.z - p.z * ahead.xy;
        precise double distance_along = dot(p, ahead);
        seen[n] = across;
        along[n] = distance_along;
        highest = max(highest, abs(distance_along));
    }
    double u0 = patch_area(seen[0], seen[2]);
    double u2 = patch_area(seen[1], seen[3]);
    double v0 = patch_area(seen[0], seen[1]);
    double v2 = patch_area(seen[2], seen[3]);
    double one = patch_area(seen[0], seen[3]);
    double other = patch_area(seen[1], seen[2]);
    precise double u1 = one + other;
    precise double v1 = one - other;
    bool has_u = u0 != 0.0LF || u1 != 0.0LF || u2 != 0.0LF;
    bool has_v = v0 != 0.0LF || v1 != 0.0LF || v2 != 0.0LF;
    bool is_of_u = max(u1 * u1, abs(u0 * u2)) < max(v1 * v1, abs(v0 * v2));
    precise double discriminant = is_of_u ? u1 * u1 - 4.0LF * u0 * u2 : v1 * v1 - 4.0LF * v0 * v2;
    if (discriminant < 0.0LF) {
        return;
    }
    double root = sqrt(discriminant);
    double first = 0.0LF;
    dvec2 uv = dvec2(0.0LF);
    for (float side = -1.0; side <= (root > 0.0LF ? 1.0 : -1.0); side += 2.0) {
        dvec2 u = patch_root(u0, u1, u2, root, double(side));
        dvec2 v = patch_root(v2, v1, v0, root, double(side)).yx;
        if (!has_u && patch_is_within(v)
            && patch_is_point(v, dvec2(along[0], along[2]), dvec2(along[1], along[3]), highest)) {
            u = dvec2(1.0LF);
        }
        if (!has_v && patch_is_within(u)
            && patch_is_point(u, dvec2(along[0], along[1]), dvec2(along[2], along[3]), highest)) {
            v = dvec2(1.0LF);
        }
        if (!patch_is_within(u) || !patch_is_within(v)) {
            continue;
        }
        u = abs(u) / (abs(u.x) + abs(u.y));
        v = abs(v) / (abs(v.x) + abs(v.y));
        precise double rest = u.y * (v.y * along[0] + v.x * along[2]) + u.x * (v.y * along[1] + v.x * along[3]);
        precise double t = double(foot) + rest / dot(d, d);
        if (t > double(tmin) && t <= double(tmax)) {
            if (hits.count == 0 || t < first) {
                first = t;
                uv = dvec2(u.x, v.x);
            }
            hits.count++;
        }
    }
    if (hits.count == 0) {
        return;
    }
    hits.t = float(first);
    dvec3 low_u = dvec3(q.q10) - dvec3(q.q00);
    dvec3 low_v = dvec3(q.q01) - dvec3(q.q00);
    if (hits.count == 2) {
        precise double volume = dot(cross(low_u, low_v), dvec3(q.q11) - dvec3(q.q00));
        hits.count = volume == 0.0LF ? 1 : 2;
    }
    precise dvec3 along_u = (1.0LF - uv.y) * low_u + uv.y * (dvec3(q.q11) - dvec3(q.q01));
    precise dvec3 along_v = (1.0LF - uv.x) * low_v + uv.x * (dvec3(q.q11) - dvec3(q.q10));
    dvec3 outward = cross(along_u, along_v);
    precise double square = dot(outward, outward);
    normal = square > 0.0LF ? vec3(outward / sqrt(square)) : vec3(0.0);
}
