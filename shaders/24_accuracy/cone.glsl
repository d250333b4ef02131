// A ray against a cone between two discs. With equal radii it is a cylinder, and with one radius of 0 it has an apex.
//
// f is the ray's origin as seen from the middle of the first disc, u the way from there to the middle of the second, d
// the ray's direction of any length. A point p at the height h = p·u, from 0 to u·u, is on the side if
// (u·u)·|p × u|² = g², where g = ra·(u·u) + (rb - ra)·h. On a ray that is a quadratic. A closed cone has its discs, an
// open one is a pipe or a funnel.
// `precise`: rounding is what this is about, so no compiler may rearrange it.

const uint CONE_TEXTBOOK = 0;
const uint CONE_STABLE = 1;

struct Cone {
    vec3 a;
    vec3 b;
    float ra;
    float rb;
    bool closed;
};

const int PART_SIDE = 0;
const int PART_A = 1;
const int PART_B = 2;

// The number of times a ray meets a surface, and the first of them.
struct Meeting {
    uint count;
    float t;
    int part;
};

void meet(inout Meeting m, float t, int part, float tmin, float tmax) {
    if (t > tmin && t <= tmax) {
        if (m.count == 0 || t < m.t) {
            m.t = t;
            m.part = part;
        }
        m.count++;
    }
}

// The discs, each by its plane. A ray within a plane misses it. `start` is the ray's t at f.
void meet_discs(inout Meeting m, Cone cone, vec3 f, vec3 d, vec3 u, float start, float tmin, float tmax) {
    precise float ud = dot(u, d);
    if (!cone.closed || ud == 0.0) {
        return;
    }
    for (int k = 0; k < 2; k++) {
        precise vec3 from = k == 0 ? f : f - u;
        precise float x = -dot(from, u) / ud;
        precise vec3 p = from + x * d;
        float r = k == 0 ? cone.ra : cone.rb;
        precise float t = start + x;
        if (dot(p, p) <= r * r) {
            meet(m, t, k == 0 ? PART_A : PART_B, tmin, tmax);
        }
    }
}

// The quadratic from dot products as they stand, with the formula from school. It divides by a, which is 0 where the ray
// is parallel to a line of the side, and subtracts numbers that grow with the distance.
Meeting cone_textbook(Cone cone, vec3 f, vec3 d, vec3 u, float tmin, float tmax) {
    precise float uu = dot(u, u);
    precise float ud = dot(u, d);
    precise float uf = dot(u, f);
    precise float g = cone.ra * uu + (cone.rb - cone.ra) * uf;
    precise float rate = (cone.rb - cone.ra) * ud;
    precise float a = uu * (uu * dot(d, d) - ud * ud) - rate * rate;
    precise float b = uu * (uu * dot(f, d) - uf * ud) - g * rate;
    precise float c = uu * (uu * dot(f, f) - uf * uf) - g * g;
    precise float discriminant = b * b - a * c;
    Meeting m = Meeting(0, 0.0, PART_SIDE);
    if (a != 0.0 && discriminant >= 0.0) {
        float root = sqrt(discriminant);
        for (int k = 0; k < (root > 0.0 ? 2 : 1); k++) {
            precise float t = (k == 0 ? -b - root : -b + root) / a;
            precise float h = uf + t * ud;
            if (h >= 0.0 && h <= uu) {
                meet(m, t, PART_SIDE, tmin, tmax);
            }
        }
    }
    meet_discs(m, cone, f, d, u, 0.0, tmin, tmax);
    return m;
}

// First the origin moves along the ray, to where it is close to the middle of the axis. The discriminant
// b² - a·c is (u·u)·(|v|² - ((u·u)·(w·e))²): no term of it is larger than the cone, and it is 0 for a tangent only. The
// second root is a quotient, which remains when a is 0.
Meeting cone_stable(Cone cone, vec3 f, vec3 d, vec3 u, float tmin, float tmax) {
    precise float start = dot(0.5 * u - f, d) / dot(d, d);
    precise vec3 w = f + start * d;
    precise vec3 e = cross(d, u);
    precise vec3 across = cross(w, u);
    precise float uu = dot(u, u);
    precise float ud = dot(u, d);
    precise float uw = dot(u, w);
    precise float g = cone.ra * uu + (cone.rb - cone.ra) * uw;
    precise float rate = (cone.rb - cone.ra) * ud;
    precise float a = uu * dot(e, e) - rate * rate;
    precise float b = uu * dot(across, e) - g * rate;
    precise float c = uu * dot(across, across) - g * g;
    precise vec3 v = g * e - rate * across;
    precise float reach = sqrt(dot(v, v));
    precise float beside = uu * abs(dot(w, e));
    precise float discriminant = uu * ((reach - beside) * (reach + beside));
    Meeting m = Meeting(0, 0.0, PART_SIDE);
    if (discriminant >= 0.0) {
        float root = sqrt(discriminant);
        precise float q = b > 0.0 ? -b - root : -b + root;
        for (int k = 0; k < 2; k++) {
            float under = k == 0 ? a : q;
            if (under == 0.0 || (k == 1 && root == 0.0 && a != 0.0)) {
                continue;
            }
            precise float x = (k == 0 ? q : c) / under;
            precise float h = uw + x * ud;
            precise float t = start + x;
            if (h >= 0.0 && h <= uu) {
                meet(m, t, PART_SIDE, tmin, tmax);
            }
        }
    }
    meet_discs(m, cone, w, d, u, start, tmin, tmax);
    return m;
}

// The outward normal at a point p, as seen from the middle of the first disc; of any length, and 0 at an apex.
vec3 cone_normal(Cone cone, vec3 p, vec3 u, int part) {
    if (part != PART_SIDE) {
        return part == PART_A ? -u : u;
    }
    float uu = dot(u, u);
    float h = dot(p, u);
    float slope = cone.rb - cone.ra;
    float g = cone.ra + slope * (h / uu);
    return p - (h / uu) * u - (g * slope / uu) * u;
}
