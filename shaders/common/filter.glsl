// Taught by 04_jitter_camera; what 28 has of it: the tent, as the inverse of its integral.

float tent(float u) {
    return u < 0.5 ? sqrt(2.0 * u) - 1.0 : 1.0 - sqrt(2.0 - 2.0 * u);
}

// Of a point that is uniform in [0, 1)^2: an offset from the middle of the pixel, in pixels.
vec2 filter_offset(vec2 u) {
    return vec2(tent(u.x), tent(u.y));
}
