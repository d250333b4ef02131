// Taught by 08_intersection.
//
// A ray against a box with sides along the axes, in two ways that are equal on paper: 08 divides, and 42 compares.
//
// A ray is in the box while it is between the walls of all three slabs. t.x is where it enters the last
// slab, t.y where it leaves the first; `faces` gets the outward normals there. The box is closed.

const uint BOX_RECIPROCAL = 0;
const uint BOX_DIVISION = 1;

const float LARGEST = 3.4028235e38;

// One division an axis, and minimum and maximum for all decisions (Kay and Kajiya 1986). Along an axis
// 1 / 0 is infinite, and in the plane of a wall 0 · infinity is not a number.
bool box_reciprocal(vec3 o, vec3 d, vec3 low, vec3 high, out vec2 t, out vec3 faces[2]) {
    precise vec3 inverse = 1.0 / d;
    precise vec3 a = (low - o) * inverse;
    precise vec3 b = (high - o) * inverse;
    vec3 enter = min(a, b);
    vec3 leave = max(a, b);
    t = vec2(max(max(enter.x, enter.y), enter.z), min(min(leave.x, leave.y), leave.z));
    uint first = enter.x == t.x ? 0 : enter.y == t.x ? 1 : 2;
    uint last = leave.x == t.y ? 0 : leave.y == t.y ? 1 : 2;
    faces[0] = vec3(0.0);
    faces[1] = vec3(0.0);
    faces[0][first] = -sign(d[first]);
    faces[1][last] = sign(d[last]);
    return t.x <= t.y;
}

// A true division: t is off by no more than Vulkan allows for a difference and a quotient, 1 + 2.5 ULP,
// and its sign is right. Where d = 0, the origin is in the slab or it is not. The sign of d
// decides which wall is entered and which is left (after Majercik et al., JCGT 7:3, 2018).
bool box_division(vec3 o, vec3 d, vec3 low, vec3 high, out vec2 t, out vec3 faces[2]) {
    t = vec2(-LARGEST, LARGEST);
    faces[0] = vec3(0.0);
    faces[1] = vec3(0.0);
    for (uint axis = 0; axis < 3; axis++) {
        if (d[axis] == 0.0) {
            if (o[axis] < low[axis] || o[axis] > high[axis]) {
                return false;
            }
            continue;
        }
        bool up = d[axis] > 0.0;
        precise float enter = ((up ? low[axis] : high[axis]) - o[axis]) / d[axis];
        precise float leave = ((up ? high[axis] : low[axis]) - o[axis]) / d[axis];
        if (enter > t.x) {
            t.x = enter;
            faces[0] = vec3(0.0);
            faces[0][axis] = up ? -1.0 : 1.0;
        }
        if (leave < t.y) {
            t.y = leave;
            faces[1] = vec3(0.0);
            faces[1][axis] = up ? 1.0 : -1.0;
        }
    }
    return t.x <= t.y;
}
