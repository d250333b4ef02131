// A ray against a bilinear patch: the surface between four corners, which two families of straight lines cover. At u, a line
// leads from the edge q00-q10 to the edge q01-q11; at v, one leads from q00-q01 to q10-q11.
//
// Edges and corners belong to the patch. Two hits at one point count once in two-floats and in 64 bits, and a ray that lies in
// the surface misses it.
// `precise`: rounding is what this is about, so no compiler may rearrange it.

const uint PATCH_TEXTBOOK = 0;
const uint PATCH_STABLE = 1;

struct Patch {
    vec3 q00;
    vec3 q10;
    vec3 q01;
    vec3 q11;
};

struct PatchHits {
    uint count;
    float t;    // of the first
    vec2 uv;
};

// Keeps a hit if it is in the ray's interval.
void patch_meet(inout PatchHits hits, float t, vec2 uv, float tmin, float tmax) {
    if (t > tmin && t <= tmax) {
        if (hits.count == 0 || t < hits.t) {
            hits.t = t;
            hits.uv = uv;
        }
        hits.count++;
    }
}

vec3 patch_normal(Patch q, vec2 uv) {
    precise vec3 along_u = mix(q.q10 - q.q00, q.q11 - q.q01, uv.y);
    precise vec3 along_v = mix(q.q01 - q.q00, q.q11 - q.q10, uv.x);
    precise vec3 normal = cross(along_u, along_v);
    return normal;
}

// Where the ray meets the line at u, if it does so between the line's ends (Reshetov 2019).
void patch_line(Patch q, vec3 o, vec3 d, float u, float tmin, float tmax, inout PatchHits hits) {
    if (!(u >= 0.0 && u <= 1.0)) {
        return;
    }
    precise vec3 start = mix(q.q00, q.q10, u) - o;
    precise vec3 line = mix(q.q01, q.q11, u) - mix(q.q00, q.q10, u);
    precise vec3 n = cross(d, line);
    precise float square = dot(n, n);
    precise float v = dot(cross(start, d), n) / square;
    precise float t = dot(cross(start, line), n) / square;
    if (v >= 0.0 && v <= 1.0) {
        patch_meet(hits, t, vec2(u, v), tmin, tmax);
    }
}

// Ray and line at u are in one plane where a polynomial c + b·u + a·u² is 0. Its coefficients are volumes measured from the
// ray's origin.
PatchHits patch_textbook(Patch q, vec3 o, vec3 d, float tmin, float tmax) {
    precise vec3 bend = cross(q.q10 - q.q00, q.q01 - q.q11);
    precise float a = dot(bend, d);
    precise float c = dot(cross(q.q00 - o, d), q.q01 - q.q00);
    precise float b = dot(cross(q.q10 - o, d), q.q11 - q.q10) - a - c;
    precise float discriminant = b * b - 4.0 * a * c;
    PatchHits hits = PatchHits(0, 0.0, vec2(0.0));
    if (!(discriminant >= 0.0)) {
        return hits;
    }
    precise float root = sqrt(discriminant);
    precise float s = b > 0.0 ? -b - root : -b + root;
    if (s != 0.0) {
        patch_line(q, o, d, 2.0 * c / s, tmin, tmax, hits);
    }
    if (a != 0.0) {
        patch_line(q, o, d, s / (2.0 * a), tmin, tmax, hits);
    }
    return hits;
}

// The index of the largest component, and a vector turned so that this component is the last.
int patch_axis(vec3 d) {
    vec3 size = abs(d);
    return size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
}

vec3 patch_turned(vec3 v, int axis) {
    return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v;
}

// The area between two points and the ray, seen along the ray.
float patch_area(vec2 p, vec2 q) {
    precise float area = p.x * q.y - p.y * q.x;
    return area;
}

// A root of last·x² + middle·x + first as a fraction, x.x / x.y: the one with +root if side is 1, with -root if it is -1.
// Only numbers of one sign are added.
vec2 patch_root(float first, float middle, float last, float root, float side) {
    if (root == 0.0 && middle == 0.0) {
        return last != 0.0 ? vec2(0.0, last) : vec2(first, 0.0);
    }
    bool is_sum = (middle >= 0.0) == (side < 0.0);
    precise float sum = (middle >= 0.0 ? -root : root) - middle;
    return is_sum ? vec2(sum, 2.0 * last) : vec2(2.0 * first, sum);
}

// True for a fraction from 0 to infinity: there u or v is from 0 to 1.
bool patch_is_within(vec2 x) {
    return x != vec2(0.0) && (min(x.x, x.y) >= 0.0 || max(x.x, x.y) <= 0.0);
}

// ANCHOR: stable
// The origin moves along the ray to the patch, which is then seen along the ray, as flat. Six areas between its corners decide
// which hits there are. They do not grow with the distance, but `there` is rounded as the ray's origin is.
PatchHits patch_stable(Patch q, vec3 o, vec3 d, float tmin, float tmax) {
    precise vec3 middle = 0.25 * (q.q00 + q.q10 + q.q01 + q.q11);
    precise float start = dot(middle - o, d) / dot(d, d);
    precise vec3 there = o + start * d;
    int axis = patch_axis(d);
    vec3 ahead = patch_turned(d, axis);
    vec3 corner[4] = vec3[4](q.q00, q.q10, q.q01, q.q11);
    vec2 seen[4];
    float along[4];
    for (int n = 0; n < 4; n++) {
        precise vec3 p = patch_turned(corner[n] - there, axis);
        precise vec2 across = p.xy * ahead.z - p.z * ahead.xy;
        precise float distance_along = dot(p, ahead) / dot(d, d);
        seen[n] = across;
        along[n] = distance_along;
    }
    // For x = u / (1 - u): u2·x² + u1·x + u0 = 0. For y = (1 - v) / v: v0·y² + v1·y + v2 = 0.
    float u0 = patch_area(seen[0], seen[2]);
    float u2 = patch_area(seen[1], seen[3]);
    float v0 = patch_area(seen[0], seen[1]);
    float v2 = patch_area(seen[2], seen[3]);
    float one = patch_area(seen[0], seen[3]);
    float other = patch_area(seen[1], seen[2]);
    precise float u1 = one + other;
    precise float v1 = one - other;
    // Both polynomials have the same discriminant (Plücker): the one with the smaller terms loses less.
    bool is_of_u = max(u1 * u1, abs(u0 * u2)) < max(v1 * v1, abs(v0 * v2));
    precise float discriminant = is_of_u ? u1 * u1 - 4.0 * u0 * u2 : v1 * v1 - 4.0 * v0 * v2;
    PatchHits hits = PatchHits(0, 0.0, vec2(0.0));
    if (!(discriminant >= 0.0) || u0 == 0.0 && u1 == 0.0 && u2 == 0.0 || v0 == 0.0 && v1 == 0.0 && v2 == 0.0) {
        return hits;
    }
    precise float root = sqrt(discriminant);
    for (float side = -1.0; side <= (root > 0.0 ? 1.0 : -1.0); side += 2.0) {
        vec2 x = patch_root(u0, u1, u2, root, side);
        vec2 y = patch_root(v2, v1, v0, root, side);
        if (!patch_is_within(x) || !patch_is_within(y)) {
            continue;
        }
        x = abs(x) / (abs(x.x) + abs(x.y));
        y = abs(y) / (abs(y.x) + abs(y.y));
        precise float t = x.y * (y.x * along[0] + y.y * along[2]) + x.x * (y.x * along[1] + y.y * along[3]);
        t += start;
        patch_meet(hits, t, vec2(x.x, y.y), tmin, tmax);
    }
    return hits;
}
// ANCHOR_END: stable
