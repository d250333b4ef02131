// A ray against a capsule: all points within r of a segment, which is a cylinder with round ends.
//
// f is the ray's origin as seen from the segment's start, u the way from there to its end, d the ray's
// direction of any length, r the radius. Where the line enters and where it leaves goes to `t`. A capsule
// is convex, so that the cylinder's root counts if it lies beside the segment, and if it lies beyond an
// end, that end's sphere has the root or there is none. u = 0 is a sphere.
#include "common/sphere.glsl"

const uint CAPSULE_TEXTBOOK = 0;
const uint CAPSULE_STABLE = 1;

// The cylinder's quadratic from dot products as they stand. Each is a difference of two numbers that
// grow with the distance.
bool capsule_textbook(vec3 f, vec3 d, vec3 u, float r, out vec2 t) {
    precise float uu = dot(u, u);
    precise float ud = dot(u, d);
    precise float uf = dot(u, f);
    precise float a = uu * dot(d, d) - ud * ud;
    precise float b = uu * dot(f, d) - uf * ud;
    precise float c = uu * (dot(f, f) - r * r) - uf * uf;
    precise float discriminant = b * b - a * c;
    t = vec2(0.0);
    if (!(discriminant >= 0.0)) {
        return false;
    }
    precise vec2 body = vec2(-b - sqrt(discriminant), -b + sqrt(discriminant)) / a;
    for (int k = 0; k < 2; k++) {
        // Along the segment, from 0 to uu. A ray along the axis comes in at one end, leaves at the other.
        precise float height = a > 0.0 ? uf + body[k] * ud : (k == 0) == (ud > 0.0) ? -1.0 : uu + 1.0;
        t[k] = body[k];
        if (!(height > 0.0 && height < uu)) {
            precise vec3 from_end = height <= 0.0 ? f : f - u;
            vec2 ends;
            if (!sphere_textbook(from_end, d, r, ends)) {
                return false;
            }
            t[k] = ends[k];
        }
    }
    return true;
}

// First the origin moves along the ray, to where it is close to the segment's middle: what follows does
// not know the distance. Then the cylinder by its distance from the ray, which is the part of w along
// the common perpendicular d × u: no term is larger than the capsule.
bool capsule_stable(vec3 f, vec3 d, vec3 u, float r, out vec2 t) {
    precise float to_middle = dot(0.5 * u - f, d) / dot(d, d);
    precise vec3 w = f + to_middle * d;
    precise vec3 across = cross(d, u);
    precise float a = dot(across, across);
    precise float beside = dot(w, across);
    precise float square = a * (r * r) - beside * beside;
    t = vec2(0.0);
    if (!(square >= 0.0)) {
        return false;
    }
    precise float uu = dot(u, u);
    precise float uw = dot(u, w);
    precise float ud = dot(u, d);
    precise float b = dot(cross(w, u), across);
    precise float root = sqrt(square * uu);
    precise vec2 body = vec2(-b - root, -b + root) / a;
    for (int k = 0; k < 2; k++) {
        precise float height = a > 0.0 ? uw + body[k] * ud : (k == 0) == (ud > 0.0) ? -1.0 : uu + 1.0;
        float own = body[k];
        if (!(height > 0.0 && height < uu)) {
            precise vec3 from_end = height <= 0.0 ? w : w - u;
            vec2 ends;
            if (!sphere_stable(from_end, d, r, ends)) {
                return false;
            }
            own = ends[k];
        }
        precise float whole = to_middle + own;
        t[k] = whole;
    }
    return true;
}

// The outward normal at a point p of the surface, as seen from the segment's start: away from the
// segment's nearest point. Its length is r.
vec3 capsule_normal(vec3 p, vec3 u) {
    float uu = dot(u, u);
    float nearest = uu > 0.0 ? clamp(dot(p, u) / uu, 0.0, 1.0) : 0.0;
    return p - nearest * u;
}
