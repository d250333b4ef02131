// Taught by 33_roots.
//
// A polynomial of degree four, its value and its derivative.
// `precise`: rounding is what this is about, so no compiler may rearrange it.

// c[0] + c[1]·x + … + c[4]·x⁴
struct Quartic {
    float c[5];
};

float value(Quartic q, float x) {
    precise float sum = q.c[4];
    for (int i = 3; i >= 0; i--) {
        sum = sum * x + q.c[i];
    }
    return sum;
}

Quartic derivative(Quartic q) {
    return Quartic(float[5](q.c[1], 2.0 * q.c[2], 3.0 * q.c[3], 4.0 * q.c[4], 0.0));
}
