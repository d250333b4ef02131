// The real roots of a quartic in closed form. After common/quartic.glsl.
// `precise`: rounding is what this is about, so no compiler may rearrange it.
#include "cardano.glsl"

// Of x² + 2b·x + c; a double root counts once.
void add_quadratic_roots(float b, float c, float shift, inout float roots[4], inout int count) {
    precise float discriminant = b * b - c;
    if (!(discriminant >= 0.0)) {
        return;
    }
    precise float root = sqrt(discriminant);
    precise float low = -b - root - shift;
    precise float high = -b + root - shift;
    roots[count++] = low;
    if (root > 0.0) {
        roots[count++] = high;
    }
}

// In no order, and a multiple root once or more often. A coefficient of at most `small` counts as 0, and then the degree is
// lower.
int quartic_roots(Quartic q, float small, out float roots[4]) {
    roots = float[4](0.0, 0.0, 0.0, 0.0);
    int count = 0;
    if (abs(q.c[4]) <= small) {
        if (abs(q.c[3]) <= small) {
            if (abs(q.c[2]) > small) {
                precise vec2 n = vec2(q.c[0], 0.5 * q.c[1]) / q.c[2];
                add_quadratic_roots(n.y, n.x, 0.0, roots, count);
            } else if (abs(q.c[1]) > small) {
                precise float root = -q.c[0] / q.c[1];
                roots[count++] = root;
            }
            return count;
        }
        precise vec3 n = vec3(q.c[0], q.c[1], q.c[2]) / q.c[3];
        float three[3];
        count = cubic_roots(n, three);
        roots = float[4](three[0], three[1], three[2], 0.0);
        return count;
    }
    // Ferrari: shifted by a quarter of the cubic term, which then is 0, the quartic is y⁴ + p·y² + l·y + r.
    precise vec4 n = vec4(q.c[0], q.c[1], q.c[2], q.c[3]) / q.c[4];
    precise float shift = 0.25 * n.w;
    precise float square = shift * shift;
    precise float p = n.z - 6.0 * square;
    precise float l = n.y - 2.0 * n.z * shift + 8.0 * square * shift;
    precise float r = n.x - n.y * shift + n.z * square - 3.0 * square * square;
    // Any root z of this cubic splits it into two quadratics; the largest is never below 0.
    precise vec3 resolvent = vec3(-l * l, p * p - 4.0 * r, 2.0 * p);
    float three[3];
    int found = cubic_roots(resolvent, three);
    float z = found == 1 ? three[0] : max(three[0], max(three[1], three[2]));
    if (z > 0.0) {
        precise float u = sqrt(z);
        precise float middle = 0.5 * (p + z);
        precise float side = 0.5 * l / u;
        add_quadratic_roots(-0.5 * u, middle + side, shift, roots, count);
        add_quadratic_roots(0.5 * u, middle - side, shift, roots, count);
        return count;
    }
    // Without a linear term it is a quadratic in y².
    precise float discriminant = 0.25 * p * p - r;
    if (discriminant >= 0.0) {
        precise float root = sqrt(discriminant);
        add_quadratic_roots(0.0, 0.5 * p - root, shift, roots, count);
        if (root > 0.0) {
            add_quadratic_roots(0.0, 0.5 * p + root, shift, roots, count);
        }
    }
    return count;
}
