// The real roots of a cubic in closed form.
// `precise`: rounding is what this is about, so no compiler may rearrange it.

// log2() of 0 is undefined.
float cube_root(float x) {
    return x == 0.0 ? 0.0 : sign(x) * exp2(log2(abs(x)) * (1.0 / 3.0));
}

// Of x³ + n.z·x² + n.y·x + n.x, one or three: Cardano's formula, and Viète's for three roots. Two or three may be equal.
int cubic_roots(vec3 n, out float roots[3]) {
    precise float middle = n.z / 3.0;
    precise float p = n.y / 3.0 - middle * middle;
    precise float q = middle * middle * middle - 0.5 * middle * n.y + 0.5 * n.x;
    precise float discriminant = q * q + p * p * p;
    roots = float[3](0.0, 0.0, 0.0);
    if (discriminant > 0.0) {
        precise float s = sqrt(discriminant);
        precise vec2 cubes = vec2(-q + s, -q - s);
        vec2 parts = vec2(cube_root(cubes.x), cube_root(cubes.y));
        roots[0] = parts.x + parts.y - middle;
        return 1;
    }
    precise float radius = sqrt(max(-p, 0.0));
    precise float angle = acos(clamp(radius > 0.0 ? -q / (radius * radius * radius) : 1.0, -1.0, 1.0)) / 3.0;
    // From -2π/3 to π: beyond π, Vulkan promises nothing about cos().
    for (int i = 0; i < 3; i++) {
        roots[i] = 2.0 * radius * cos(min(angle + float(i - 1) * 2.09439510, 3.14159265)) - middle;
    }
    return 3;
}
