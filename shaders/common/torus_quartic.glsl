// Taught by 33_roots.
//
// A ray against a torus, as a polynomial of degree four.
//
// Seen from the centre, a point p lies on the torus if (|p|² + R² - r²)² = 4R²·(|p|² - (p·n)²), where n is the
// unit axis, R the distance from the centre to the middle of the tube, and r the tube's radius. With the ray's
// point p = f + x·d both sides are polynomials in x.
// `precise`: rounding is what this is about, so no compiler may rearrange it.
#include "quartic.glsl"
#include "torus.glsl"

// Where a line goes through the surface.
struct TorusCrossing {
    float t;
    vec3 ring;       // from the centre towards the middle of the tube there: unit
    vec3 outward;    // the unit normal
};

// ANCHOR: line
// The line with its origin moved to the point nearest to the centre, a unit direction, and R as the unit of length.
struct Line {
    vec3 p;
    vec3 d;
    float t;       // the ray's t at p
    float unit;    // t changes by this per unit of length
};

Line line_near(vec3 f, vec3 d, float major) {
    precise float dd = dot(d, d);
    precise float t = -dot(f, d) / dd;
    precise vec3 p = f + t * d;
    // The second step removes the rounding error of the first.
    precise float rest = -dot(p, d) / dd;
    p += rest * d;
    t += rest;
    precise float speed = sqrt(dd);
    return Line(p / major, d / speed, t, major / speed);
}

// At that point p·d = 0 and |d| = 1, which leaves no cubic term, and no coefficient is larger than about 16.
Quartic quartic_at_foot(Line line, vec3 n, float minor) {
    precise float m = dot(line.p, line.p) - 1.0 - minor * minor;
    precise float h = dot(line.p, n);
    precise float rate = dot(line.d, n);
    precise float c0 = m * m + 4.0 * (h - minor) * (h + minor);
    precise float c1 = 8.0 * h * rate;
    precise float c2 = 2.0 * m + 4.0 * rate * rate;
    return Quartic(float[5](c0, c1, c2, 0.0, 1.0));
}
// ANCHOR_END: line

// The search ends where the line leaves the ball around the torus: so far from that point, to both sides.
bool reach_in_ball(Line line, float minor, out float reach) {
    precise float square = (1.0 + minor) * (1.0 + minor) - dot(line.p, line.p);
    reach = sqrt(max(square, 0.0)) + 0.001;
    return square >= -1e-4;
}

// Ring and normal at a point p relative to the centre, in units of R. The middle of the hole of a torus without a
// hole has no ring: there the normal looks back along the ray.
TorusCrossing crossing_at(float t, vec3 p, vec3 n, vec3 d) {
    precise float h = dot(p, n);
    precise vec3 across = p - h * n;
    precise float size = sqrt(dot(across, across));
    vec3 ring = size > 0.0 ? across / size : vec3(0.0);
    precise vec3 outward = (size - 1.0) * ring + h * n;
    precise float square = dot(outward, outward);
    return TorusCrossing(t, ring, size > 0.0 && square > 0.0 ? outward / sqrt(square) : -normalize(d));
}
