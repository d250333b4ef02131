// Taught by 04_jitter_camera.
//
// Filters, as the inverse of their integral: of a number that is uniform in [0, 1) they make an offset
// from the middle of the pixel, in pixels, that is near a place as often as the filter is high there.

const uint FILTER_BOX = 0;
const uint FILTER_TENT = 1;
const uint FILTER_BLACKMAN_HARRIS = 2;

const uint PIECES = 1024;

layout(set = 0, binding = 3, scalar) readonly buffer Offsets { float at[PIECES + 1]; } offsets;

float tent(float u) {
    return u < 0.5 ? sqrt(2.0 * u) - 1.0 : 1.0 - sqrt(2.0 - 2.0 * u);
}

float blackman_harris(float u) {
    float place = u * PIECES;
    uint piece = uint(place);
    return mix(offsets.at[piece], offsets.at[piece + 1], place - piece);
}

vec2 filter_offset(vec2 u) {
    if (push.pixel_filter == FILTER_TENT) {
        return vec2(tent(u.x), tent(u.y));
    }
    if (push.pixel_filter == FILTER_BLACKMAN_HARRIS) {
        return vec2(blackman_harris(u.x), blackman_harris(u.y));
    }
    return u - 0.5;
}
