// A ray against the box of a node: where it enters, or that it misses. Nothing is drawn of a box: one that
// is met for nothing costs time, and one that is missed wrongly costs a hit.
#include "common/crossing.glsl"

const float MISSED = 3e38;

// ANCHOR: ray
// A ray prepared for the tests of boxes, once for each tree that it walks.
struct Ray {
    vec3 origin;
    vec3 direction;
    vec3 inverse;
    float growth;         // by how much boxes grow
};

// `growth` is that of a box per unit of the largest coordinate; `reach` is the largest coordinate in the tree.
Ray ray_through(vec3 origin, vec3 direction, float growth, float reach) {
    float farthest = max(max(abs(origin.x), abs(origin.y)), abs(origin.z)) + reach;
    float grown = BOXES == BOXES_BOUND ? growth * farthest : BOXES == BOXES_GUESS ? 1e-5 : 0.0;
    // The walls are chosen by the sign, also that of 0 and -0. Vulkan does not define 1 / 0, so each component
    // counts as at least this fraction of the largest.
    const float LEAST = 1.0 / (1 << 30) / (1 << 30);
    vec3 side = mix(vec3(-1.0), vec3(1.0), greaterThanEqual(direction, vec3(0.0)));
    vec3 size = abs(direction);
    size = max(size, LEAST * max(size.x, max(size.y, size.z)));
    return Ray(origin, direction, side / size, grown);
}
// ANCHOR_END: ray

// Where the ray enters a box, between 0 and `tmax`, or MISSED. The direction's sign says which wall of a pair
// is the near one; so a box whose low corner lies above its high one is missed by all rays.
float entered_slabs(Ray ray, vec3 low, vec3 high, float tmax) {
    bvec3 up = greaterThanEqual(ray.direction, vec3(0.0));
    // The growth moves the origin: once for both boxes.
    precise vec3 to_low = low - (ray.origin + ray.growth);
    precise vec3 to_high = high - (ray.origin - ray.growth);
    precise vec3 near = mix(to_high, to_low, up) * ray.inverse;
    precise vec3 far = mix(to_low, to_high, up) * ray.inverse;
    // Each chain begins with a number, so the compiler needs no test for NaN at each step.
    float enter = max(near.x, max(near.y, max(near.z, 0.0)));
    float leave = min(tmax, min(far.x, min(far.y, min(far.z, MISSED))));
    if (BOXES == BOXES_IZE || BOXES == BOXES_BOUND) {
        precise float later = leave * SLACK;
        leave = later;
    }
    return enter <= leave ? enter : MISSED;
}

// The same, where each comparison is exact: what is compared is multiplied out, not divided.
float entered_exactly(Ray ray, vec3 low, vec3 high, float tmax) {
    if (low.x > high.x) {
        return MISSED;
    }
    Crossing enter = Crossing(vec2(0.0), 1.0, vec3(0.0));
    Crossing leave = Crossing(vec2(tmax, 0.0), 1.0, vec3(0.0));
    for (uint axis = 0; axis < 3; axis++) {
        float speed = abs(ray.direction[axis]);
        vec2 to_low = two_sum(low[axis], -ray.origin[axis]);
        vec2 to_high = two_sum(high[axis], -ray.origin[axis]);
        if (speed == 0.0) {
            if (to_low.x > 0.0 || to_high.x < 0.0) {
                return MISSED;
            }
            continue;
        }
        bool up = ray.direction[axis] > 0.0;
        Crossing into = Crossing(up ? to_low : -to_high, speed, vec3(0.0));
        Crossing out_of = Crossing(up ? to_high : -to_low, speed, vec3(0.0));
        if (before(enter, into)) {
            enter = into;
        }
        if (before(out_of, leave)) {
            leave = out_of;
        }
    }
    return before(leave, enter) ? MISSED : enter.distance.x / enter.speed;
}

float entered(Ray ray, Child child, float tmax) {
    return BOXES == BOXES_TWO_FLOAT
        ? entered_exactly(ray, child.low, child.high, tmax)
        : entered_slabs(ray, child.low, child.high, tmax);
}
