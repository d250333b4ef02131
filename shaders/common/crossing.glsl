// Taught by 24_accuracy.
//
// Where a ray crosses a plane, undivided, so that two crossings are compared exactly.
#include "common/two_float.glsl"

// Where a ray crosses the plane of a wall: at t = distance / speed, which is left undivided.
struct Crossing {
    vec2 distance;   // from the origin to the wall, along the axis: the difference of two floats, exactly
    float speed;     // the direction's component along the axis, made positive
    vec3 face;       // outward normal of the wall
};

// True if the ray crosses a before b: p / v < q / w is p·w < q·v, and that is a sum of products.
bool before(Crossing a, Crossing b) {
    // Of the speeds, only their ratio matters; the products shall not underflow.
    int size = max(exponent_of(a.speed), exponent_of(b.speed));
    vec3 sum = vec3(0.0);
    sum_add_product(sum, a.distance, scaled(b.speed, -size));
    sum_add_product(sum, b.distance, -scaled(a.speed, -size));
    return sum_total(sum).x < 0.0;
}
