// The roots of a polynomial of degree four in closed form (Ferrari 1545; as in J. Schwarze, Graphics Gems, 1990).
// Square roots of differences decide whether there are roots, so near a double root rounding decides.

// A third of the exponent is a guess that is off by a twentieth; Newton's method doubles its digits in each step.
float cube_root(float x) {
    float size = abs(x);
    if (!(size > 1e-36)) {
        return 0.0;
    }
    float y = uintBitsToFloat(floatBitsToUint(size) / 3 + 0x2a514067u);
    for (int i = 0; i < 4; i++) {
        y -= (y - size / (y * y)) / 3.0;
    }
    return sign(x) * y;
}

// The cosine of a third of an angle, from the cosine: the largest root of 4y³ - 3y - cosine. Vulkan promises few
// digits of acos(), so this takes Newton's method also. The first guess is right at both ends.
float cosine_of_third(float cosine) {
    float y = 0.5 + 0.5 * sqrt(0.5 + 0.5 * cosine);
    for (int i = 0; i < 5; i++) {
        y -= ((4.0 * y * y - 3.0) * y - cosine) / max(12.0 * y * y - 3.0, 1e-3);
    }
    return y;
}

// The largest real root of x³ + a·x² + b·x + c (Cardano, and Vieta where there are three).
float largest_of_cubic(float a, float b, float c) {
    precise float third = a / 3.0;
    precise float p = b / 3.0 - third * third;
    precise float q = third * third * third - 0.5 * third * b + 0.5 * c;
    precise float discriminant = q * q + p * p * p;
    if (discriminant >= 0.0) {
        precise float far = q > 0.0 ? -q - sqrt(discriminant) : -q + sqrt(discriminant);
        float u = cube_root(far);
        return (u != 0.0 ? u - p / u : 0.0) - third;
    }
    float size = sqrt(-p);
    float cosine = clamp(-q / (size * size * size), -1.0, 1.0);
    return 2.0 * size * cosine_of_third(cosine) - third;
}

// ANCHOR: ferrari
// The real roots, in order, and their number.
int ferrari(Quartic q, out vec4 roots) {
    // x = y - a/4 leaves y⁴ + p·y² + s·y + r.
    precise float a = q.c[3] / q.c[4];
    precise float b = q.c[2] / q.c[4];
    precise float c = q.c[1] / q.c[4];
    precise float aa = a * a;
    precise float p = b - 0.375 * aa;
    precise float s = 0.125 * a * aa - 0.5 * a * b + c;
    precise float r = q.c[0] / q.c[4] - 0.01171875 * aa * aa + 0.0625 * aa * b - 0.25 * a * c;
    // With a root z of this cubic, it is the product of two quadratics.
    float z = largest_of_cubic(-0.5 * p, -r, 0.5 * r * p - 0.125 * s * s);
    precise float u = sqrt(max(z * z - r, 0.0));
    precise float v = 0.5 * sqrt(max(2.0 * z - p, 0.0));
    float side = s < 0.0 ? -v : v;
    vec2 first;
    vec2 second;
    bool has_first = quadratic(side, z - u, first);
    bool has_second = quadratic(-side, z + u, second);
    precise vec4 all = vec4(has_first ? first : vec2(1e38), has_second ? second : vec2(1e38)) - 0.25 * a;
    // Two sorted pairs become one sorted list.
    vec2 low = min(all.xy, all.zw);
    vec2 high = max(all.xy, all.zw);
    roots = vec4(low.x, min(high.x, low.y), max(high.x, low.y), high.y);
    return (has_first ? 2 : 0) + (has_second ? 2 : 0);
}
// ANCHOR_END: ferrari
