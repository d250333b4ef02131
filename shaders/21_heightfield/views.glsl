// The cost of a march, and its error, in place of the picture.
#include "common/heat.glsl"

const float FAR = 1e30;

// The ground alone, without the pieces: an intersection shader has no payload to count in, but the march
// is a function like any other, and can be called here.
vec4 march(vec3 origin, vec3 direction) {
    HeightfieldHit found = meet_ground(RUNG, origin, direction, 0.0, FAR);
    if (SHOW == SHOW_STEPS) {
        return vec4(heat(float(found.steps) / 150.0), 1.0);
    }
    if (SHOW == SHOW_MARCH) {
        return vec4(found.met ? found.t : -1.0, found.steps, 0.0, 1.0);
    }
    // The last rung errs nowhere: the page's test holds it to 64 bits.
    HeightfieldHit best = meet_ground(HEIGHTFIELD_BISECTED, origin, direction, 0.0, FAR);
    if (found.met != best.met) {
        return vec4(found.met ? vec3(0.8, 0.0, 0.8) : vec3(0.0, 0.8, 0.8), 1.0);   // false, lost
    }
    if (!found.met) {
        return vec4(vec3(0.5), 1.0);
    }
    // Relative, from a millionth to all. Too near is hot; by a thousandth too far is green.
    float error = (found.t - best.t) / best.t;
    float size = clamp(log2(max(abs(error), 1e-6) * 1e6) / log2(1e6), 0.0, 1.0);
    return vec4(error > 1e-3 ? vec3(0.1, 0.4 + 0.5 * size, 0.1) : heat(size), 1.0);
}
