// A ray against a box, a third way: as the reciprocal of common/box.glsl, and never a miss by rounding.
#include "common/box.glsl"

const uint BOX_PADDED = 2;

// The reciprocal again, but a box that is missed by no more than rounding counts as met: what holds
// other things must not lose them, and may well be offered for nothing (Ize, JCGT 2:2, 2013).
// A difference rounds once, a reciprocal by up to 2.5 ULP = 5u in Vulkan, u = 2^-24, a product once:
// 7u to either side. (Ize has 3u, for a division that rounds once.) Rounded up to 16u.
bool box_padded(vec3 o, vec3 d, vec3 low, vec3 high, out vec2 t, out vec3 faces[2]) {
    const float PADDING = 16.0 / 16777216.0;
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
        // Not infinite, even if 1 / d is: 0 times that would not be a number.
        float inverse = clamp(1.0 / d[axis], -LARGEST, LARGEST);
        precise float a = (low[axis] - o[axis]) * inverse;
        precise float b = (high[axis] - o[axis]) * inverse;
        if (min(a, b) > t.x) {
            t.x = min(a, b);
            faces[0] = vec3(0.0);
            faces[0][axis] = -sign(d[axis]);
        }
        if (max(a, b) < t.y) {
            t.y = max(a, b);
            faces[1] = vec3(0.0);
            faces[1][axis] = sign(d[axis]);
        }
    }
    precise float padding = PADDING * max(abs(t.x), abs(t.y));
    return t.x - t.y <= padding;
}
