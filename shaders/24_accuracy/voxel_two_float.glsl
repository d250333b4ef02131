// A ray against a voxel in two-floats: voxel_bracketed() with exact signs at the faces and at a touch. After voxel.glsl, and
// two_float.glsl's sums and products, which say what they need.
#include "common/two_float.glsl"

const uint VOXEL_TWO_FLOAT = 3;

// A mean of two numbers, not yet divided by the edge: by the distances to its ends.
vec2 voxel_between(vec2 a, vec2 b, vec2 from_low, vec2 to_high) {
    return ff_add(ff_mul(a, to_high), ff_mul(b, from_low));
}

vec2 voxel_at(vec2 c[4], vec2 t) {
    return ff_add(ff_mul(ff_add(ff_mul(ff_add(ff_mul(c[3], t), c[2]), t), c[1]), t), c[0]);
}

// A number's sign as -1, 0 or 1.
int voxel_sign(vec2 a) {
    return a.x > 0.0 ? 1 : a.x < 0.0 ? -1 : 0;
}

vec2 voxel_root(vec2 c[4], vec2 low, vec2 high, int sign_at_low) {
    vec2 t = 0.5 * ff_add(low, high);
    for (int i = 0; i < 100; i++) {
        vec2 value = voxel_at(c, t);
        if (value.x == 0.0) {
            break;
        }
        if (voxel_sign(value) == sign_at_low) {
            low = t;
        } else {
            high = t;
        }
        precise float slope = (3.0 * c[3].x * t.x + 2.0 * c[2].x) * t.x + c[1].x;
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

// ANCHOR: voxel
// The sign of the mean where the ray crosses a face across axis k. Distances are multiplied by |d[k]|, so that nothing is
// divided: with simple numbers, this is exact.
int voxel_sign_at_face(Voxel v, vec2 from_low[3], vec2 to_high[3], vec3 d, int k, bool is_high) {
    int i = (k + 1) % 3;
    int j = (k + 2) % 3;
    vec2 way = is_high ? to_high[k] : -from_low[k];
    vec2 a0 = ff_determinant(to_high[i], way, d[i], d[k]);
    vec2 a1 = ff_determinant(from_low[i], way, -d[i], d[k]);
    vec2 b0 = ff_determinant(to_high[j], way, d[j], d[k]);
    vec2 b1 = ff_determinant(from_low[j], way, -d[j], d[k]);
    int corner = is_high ? 1 << k : 0;
    vec2 at_0 = ff_determinant(a1, a0, -v.corner[corner], v.corner[corner + (1 << i)]);
    vec2 at_1 = ff_determinant(a1, a0, -v.corner[corner + (1 << j)], v.corner[corner + (1 << i) + (1 << j)]);
    return voxel_sign(voxel_between(at_0, at_1, b1, b0));
}

void voxel_two_float(Voxel v, vec3 o, vec3 d, float tmin, float tmax, out VoxelHits hits) {
    hits = VoxelHits(0, 0.0);
    // No edge is longer than about 1, nor is the direction.
    int speed = exponent_of(d);
    d = scaled(d, -speed);
    int size = exponent_of(v.high - v.low);
    v.low = scaled(v.low, -size);
    v.high = scaled(v.high, -size);
    o = scaled(o, -size);
    float most = 0.0;
    for (int n = 0; n < 8; n++) {
        most = max(most, abs(v.corner[n]));
    }
    for (int n = 0; n < 8; n++) {
        v.corner[n] = scaled(v.corner[n], -exponent_of(most));
    }
    // A whole number, so that no product with d rounds.
    precise float foot = dot(0.5 * v.low + 0.5 * v.high - o, d) / dot(d, d);
    precise float start = floor(foot + 0.5);
    vec2 from_low[3];
    vec2 to_high[3];
    vec2 enter = vec2(-1e30, 0.0);
    vec2 leave = vec2(1e30, 0.0);
    int enters_at = 0;
    int leaves_at = 0;
    bool has_first = true;
    bool has_last = true;
    for (int k = 0; k < 3; k++) {
        vec3 sum = vec3(o[k], 0.0, 0.0);
        sum_add_product(sum, start, d[k]);
        vec2 there = sum_total(sum);
        sum = vec3(-v.low[k], 0.0, 0.0);
        sum_add(sum, there);
        from_low[k] = sum_total(sum);
        sum = vec3(v.high[k], 0.0, 0.0);
        sum_add(sum, -there);
        to_high[k] = sum_total(sum);
        if (d[k] == 0.0) {
            if (from_low[k].x < 0.0 || to_high[k].x <= 0.0) {
                return;
            }
            continue;
        }
        bool rises = d[k] > 0.0;
        vec2 first = ff_div(rises ? -from_low[k] : to_high[k], vec2(d[k], 0.0));
        vec2 last = ff_div(rises ? to_high[k] : -from_low[k], vec2(d[k], 0.0));
        if (ff_less(enter, first)) {
            enter = first;
            enters_at = k;
            has_first = rises;
        } else if (first == enter) {
            has_first = has_first && rises;
        }
        if (ff_less(last, leave)) {
            leave = last;
            leaves_at = k;
            has_last = !rises;
        } else if (last == leave) {
            has_last = has_last && !rises;
        }
    }
    // The ray's own ends: a sign there tells the side of a root that is at tmin.
    vec2 first_t = ff_sub(vec2(scaled(tmin, speed - size), 0.0), vec2(start, 0.0));
    float last = scaled(tmax, speed - size);
    vec2 last_t = last < 1e30 ? ff_sub(vec2(last, 0.0), vec2(start, 0.0)) : leave;
    if (!ff_less(first_t, enter)) {
        enter = first_t;
        enters_at = -1;
        has_first = false;
    }
    if (ff_less(last_t, leave)) {
        leave = last_t;
        leaves_at = -1;
        has_last = true;
    }
    if (ff_less(leave, enter)) {
        return;
    }
    // The coefficients: linear along x, of degree two with y, of degree three with z.
    vec2 x[8];
    for (int n = 0; n < 4; n++) {
        x[2 * n] = ff_determinant(from_low[0], to_high[0], -v.corner[2 * n], v.corner[2 * n + 1]);
        x[2 * n + 1] = ff_mul(two_sum(v.corner[2 * n + 1], -v.corner[2 * n]), d.x);
    }
    vec2 y[6];
    for (int n = 0; n < 2; n++) {
        int m = 4 * n;
        y[3 * n] = voxel_between(x[m], x[m + 2], from_low[1], to_high[1]);
        y[3 * n + 1] = ff_add(voxel_between(x[m + 1], x[m + 3], from_low[1], to_high[1]), ff_mul(ff_sub(x[m + 2], x[m]), d.y));
        y[3 * n + 2] = ff_mul(ff_sub(x[m + 3], x[m + 1]), d.y);
    }
    vec2 c[4];
    for (int n = 0; n < 4; n++) {
        vec2 from_mean = n < 3 ? voxel_between(y[n], y[n + 3], from_low[2], to_high[2]) : vec2(0.0);
        vec2 from_step = n > 0 ? ff_mul(ff_sub(y[n + 2], y[n - 1]), d.z) : vec2(0.0);
        c[n] = ff_add(from_mean, from_step);
    }
    if (c[0].x == 0.0 && c[1].x == 0.0 && c[2].x == 0.0 && c[3].x == 0.0) {
        return;
    }
    int faces[2];
    for (int n = 0; n < 2; n++) {
        int k = n == 0 ? enters_at : leaves_at;
        int axis = max(k, 0);
        faces[n] = k < 0 ? voxel_sign(voxel_at(c, n == 0 ? enter : leave))
                         : voxel_sign_at_face(v, from_low, to_high, d, axis, (d[axis] > 0.0) == (n == 1));
    }
    vec2 places[4] = vec2[4](enter, enter, enter, enter);
    int signs[4] = int[4](faces[0], 0, 0, 0);
    int count = 1;
    vec2 p = ff_sub(ff_mul(c[2], c[2]), 3.0 * ff_mul(c[3], c[1]));
    if (p.x > 0.0) {
        vec2 root = ff_sqrt(p);
        vec2 s = c[2].x >= 0.0 ? -ff_add(c[2], root) : ff_sub(root, c[2]);
        vec2 a = ff_div(c[1], s);
        vec2 b = c[3].x != 0.0 ? ff_div(s, ff_mul(c[3], 3.0)) : a;
        vec2 ends[2] = vec2[2](ff_less(b, a) ? b : a, ff_less(b, a) ? a : b);
        // A double root is at one of them: whether there is one does not depend on where.
        vec2 q = ff_sub(ff_mul(c[2], c[1]), ff_mul(ff_mul(c[0], c[3]), 9.0));
        vec2 r = ff_sub(ff_mul(c[1], c[1]), ff_mul(ff_mul(c[0], c[2]), 3.0));
        bool is_double = ff_sub(4.0 * ff_mul(p, r), ff_mul(q, q)).x == 0.0;
        precise float double_root = -0.5 * q.x / p.x;
        int touched = abs(ends[0].x - double_root) <= abs(ends[1].x - double_root) ? 0 : 1;
        for (int n = 0; n < (c[3].x != 0.0 ? 2 : 1); n++) {
            if (ff_less(enter, ends[n]) && ff_less(ends[n], leave)) {
                places[count] = ends[n];
                signs[count] = is_double && n == touched ? 0 : voxel_sign(voxel_at(c, ends[n]));
                count++;
            }
        }
    }
    places[count] = leave;
    signs[count] = faces[1];
    bool is_long = ff_less(enter, leave);
    for (int n = 0; n <= count; n++) {
        bool is_between = n > 0 && signs[n - 1] * signs[n] < 0;
        bool is_there = signs[n] == 0 && (n == 0 ? has_first && (is_long || has_last) : n < count || has_last && is_long);
        if (!is_between && !is_there) {
            continue;
        }
        vec2 t = is_there ? places[n] : voxel_root(c, places[n - 1], places[n], signs[n - 1]);
        hits.t = hits.count == 0 ? scaled(ff_add(vec2(start, 0.0), t), size - speed).x : hits.t;
        hits.count++;
    }
}
// ANCHOR_END: voxel
