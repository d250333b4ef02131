// The ground: where a ray meets it, in its box.
#include "common/box.glsl"

// Where a ray enters the ground's box and where it leaves it; x > y if it passes by.
vec2 in_the_box(vec3 o, vec3 d, float tmin, float tmax) {
    vec2 t;
    vec3 faces[2];
    if (!box_division(o, d, push.ground.low, push.ground.high, t, faces)) {
        return vec2(0.0, -1.0);
    }
    return vec2(max(t.x, tmin), min(t.y, tmax));
}

// Where a ray meets the ground, by a rung. A direction's length is 1 but for its rounding; the older rungs
// take t for a length.
HeightfieldHit meet_ground(uint rung, vec3 o, vec3 d, float tmin, float tmax) {
    vec2 within = in_the_box(o, d, tmin, tmax);
    if (within.x > within.y) {
        return HeightfieldHit(false, 0.0, 0);
    }
    float unit = rung <= HEIGHTFIELD_LIPSCHITZ || rung == HEIGHTFIELD_SECANT ? length(d) : 1.0;
    HeightfieldHit hit = heightfield_by(
        rung, push.ground.shape, o, d / unit, within.x * unit, within.y * unit);
    hit.t /= unit;
    return hit;
}
