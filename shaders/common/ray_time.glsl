// Taught by 23_motion_blur.
//
// ANCHOR: carry
// A ray carries its time as the start of its interval: the intersection shader sees the ray, and no payload.
// A product with a power of two rounds nothing, and no surface is nearer than 2^-64.
const float TIME_UNIT = 5.421010862427522e-20;

float tmin_of(float time) {
    return time * TIME_UNIT;
}

float time_of(float tmin) {
    return tmin * (1.0 / TIME_UNIT);
}
// ANCHOR_END: carry
