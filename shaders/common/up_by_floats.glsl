// Taught by 26_leaving_a_surface.

// Up by so many floats: a step that grows with the coordinate. Near zero, where floats lie dense, a
// fixed length instead (Waechter and Binder, Ray Tracing Gems, chapter 6; the constants are theirs).
vec3 up_by_floats(vec3 point, vec3 normal) {
    ivec3 steps = ivec3(256.0 * normal);
    ivec3 bits = floatBitsToInt(point) + mix(steps, -steps, lessThan(point, vec3(0.0)));
    vec3 near_zero = point + (1.0 / 65536.0) * normal;
    return mix(intBitsToFloat(bits), near_zero, lessThan(abs(point), vec3(1.0 / 32.0)));
}
