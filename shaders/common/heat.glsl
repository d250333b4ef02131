// Taught by 21_heightfield.
//
// A number as a colour.

// From dark blue over red to yellow and white, for 0 to 1.
vec3 heat(float part) {
    vec3 x = clamp(part * vec3(2.2, 1.7, 4.0) - vec3(0.25, 0.7, 3.0), 0.0, 1.0);
    return x + vec3(0.02, 0.02, 0.3) * max(1.0 - 2.5 * part, 0.0);
}
