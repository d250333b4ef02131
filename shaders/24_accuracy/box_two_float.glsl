// A ray against a box, where common/box.glsl ends: every decision exact, and one division at the end.
#include "common/two_float.glsl"

const uint BOX_TWO_FLOAT = 3;

#include "common/crossing.glsl"

// The first hit with tmin < t <= tmax. As in box_division(), but two walls that are crossed at almost
// the same t are compared exactly; so the box has no leaks at its edges, and no false hits there.
bool box_two_float(
    vec3 o, vec3 d, float tmin, float tmax, vec3 low, vec3 high, out float t, out vec3 normal) {
    t = 0.0;
    normal = vec3(0.0);
    if (d == vec3(0.0)) {
        return false;
    }
    // Everything becomes smaller than 2, so that no product overflows.
    int size = exponent_of(max(max(abs(o), abs(low)), abs(high)));
    int speed = exponent_of(d);
    o = scaled(o, -size);
    low = scaled(low, -size);
    high = scaled(high, -size);
    d = scaled(d, -speed);
    // A ray that meets the box does so at |t| < 8 in these units.
    const float FARTHEST = 8.0;
    vec2 limits = clamp(scaled(vec2(tmin, tmax), speed - size), -FARTHEST, FARTHEST);
    Crossing nearest = Crossing(vec2(limits.x, 0.0), 1.0, normal);
    Crossing farthest = Crossing(vec2(limits.y, 0.0), 1.0, normal);
    Crossing enter = Crossing(vec2(-FARTHEST, 0.0), 1.0, normal);
    Crossing leave = Crossing(vec2(FARTHEST, 0.0), 1.0, normal);
    for (uint axis = 0; axis < 3; axis++) {
        if (d[axis] == 0.0) {
            if (o[axis] < low[axis] || o[axis] > high[axis]) {
                return false;
            }
            continue;
        }
        bool up = d[axis] > 0.0;
        vec3 face = vec3(0.0);
        face[axis] = up ? 1.0 : -1.0;
        vec2 first = two_sum(up ? low[axis] : high[axis], -o[axis]);
        vec2 last = two_sum(up ? high[axis] : low[axis], -o[axis]);
        Crossing into = Crossing(up ? first : -first, abs(d[axis]), -face);
        Crossing out_of = Crossing(up ? last : -last, abs(d[axis]), face);
        if (before(enter, into)) {
            enter = into;
        }
        if (before(out_of, leave)) {
            leave = out_of;
        }
    }
    if (before(leave, enter)) {
        return false;
    }
    Crossing hit = enter;
    if (!before(nearest, enter)) {
        hit = leave;
    }
    if (!before(nearest, hit) || before(farthest, hit)) {
        return false;
    }
    t = scaled(ff_div(hit.distance, vec2(hit.speed, 0.0)), size - speed).x;
    normal = hit.face;
    return true;
}
