// Taught by 21_heightfield.
//
// A ray against a landscape, y = H(x, z): five ways of marching.
//
// There is no formula for the hit. A march asks how high the ray is above the ground, and steps ahead by
// as much as that seems to allow. `steps` counts the questions: they are what a march costs.

const uint HEIGHTFIELD_RELAXED = 0;
const uint HEIGHTFIELD_LIPSCHITZ = 1;
const uint HEIGHTFIELD_OVER_RELAXED = 2;
const uint HEIGHTFIELD_BISECTED = 3;
const uint HEIGHTFIELD_SECANT = 4;

// A march of more steps has lost its way.
const uint MARCH_LIMIT = 10000;

// ANCHOR: shape
// H(x, z) = k·(a·S(fx·x)·S(fz·z + 1/4) + b·S(gx·x + gz·z)).
struct HeightfieldShape {
    float k;
    float a;
    float fx;
    float fz;
    float b;
    float gx;
    float gz;
    float lipschitz;   // no slope is steeper
};

struct HeightfieldHit {
    bool met;
    float t;
    uint steps;
};

// The phase of a wave of length 1, from -1/2 to 1/2. At the ends, where rounding decides, S is 0 from both
// sides, with the same slope.
float phase(float u) {
    return u - floor(u + 0.5);
}

// A wave of length 1 and height 1 made of two parabolas, with only products and sums, as on the CPU.
float wave(float u) {
    precise float v = phase(u);
    precise float height = 8.0 * v * (1.0 - 2.0 * abs(v));
    return height;
}

float wave_slope(float u) {
    return 8.0 - 32.0 * abs(phase(u));
}

float heightfield_height(HeightfieldShape shape, vec2 p) {
    precise float hills = wave(shape.fx * p.x) * wave(shape.fz * p.y + 0.25);
    precise float height = shape.k * (shape.a * hills + shape.b * wave(shape.gx * p.x + shape.gz * p.y));
    return height;
}

// The unit normal above the point (x, z); it points up.
vec3 heightfield_normal(HeightfieldShape shape, vec2 p) {
    float u = shape.fx * p.x;
    float v = shape.fz * p.y + 0.25;
    float across = shape.b * wave_slope(shape.gx * p.x + shape.gz * p.y);
    float dx = shape.k * (shape.a * shape.fx * wave_slope(u) * wave(v) + across * shape.gx);
    float dz = shape.k * (shape.a * shape.fz * wave(u) * wave_slope(v) + across * shape.gz);
    return normalize(vec3(-dx, 1.0, -dz));
}

// The height of a ray above the ground.
float height_above(HeightfieldShape shape, vec3 o, vec3 d, float t) {
    precise vec3 p = o + t * d;
    precise float above = p.y - heightfield_height(shape, p.xz);
    return above;
}
// ANCHOR_END: shape

// A fixed part of the height, until that is small beside t. Where the ground comes up faster than the
// step allows for, the ray is through; where it comes slowly, the march ends too early or not at all,
// and what it has then is called a hit.
HeightfieldHit heightfield_relaxed(HeightfieldShape shape, vec3 o, vec3 d, float tmin, float tmax) {
    float t = tmin;
    uint steps = 0;
    for (; steps < 300; steps++) {
        float above = height_above(shape, o, d, t);
        if (abs(above) < 0.0015 * t || t > tmax) {
            break;
        }
        t += 0.4 * above;
    }
    return HeightfieldHit(t > tmin && t < tmax, t, steps);
}

// The same march, and at its end one step to where a straight line through the last two heights meets the
// ground (the secant's): as terrain is usually marched. The height that is left shrinks, and what went through
// or was invented stays so.
HeightfieldHit heightfield_secant(HeightfieldShape shape, vec3 o, vec3 d, float tmin, float tmax) {
    float t = tmin;
    vec2 last = vec2(tmin, 0.0);    // the step before: its t and its height
    uint steps = 0;
    for (; steps < 300; steps++) {
        float above = height_above(shape, o, d, t);
        if (t > tmax) {
            break;
        }
        if (abs(above) < 0.0015 * t) {
            float slope = (above - last.y) / (t - last.x);
            t -= steps > 0 && slope < 0.0 ? above / slope : 0.0;
            break;
        }
        last = vec2(t, above);
        t += 0.4 * above;
    }
    return HeightfieldHit(t > tmin && t < tmax, t, steps);
}

// ANCHOR: lipschitz
// The speed at which a ray can come down on the ground, per unit of t: the ground rises by its steepest slope at
// most, wherever the ray goes. A step that is no longer than height / falling jumps over nothing.
float falling(HeightfieldShape shape, vec3 d) {
    return shape.lipschitz * length(d.xz) - d.y;
}

// The relaxed march with that step: it loses nothing, but finds many hits that are not there.
HeightfieldHit heightfield_lipschitz(HeightfieldShape shape, vec3 o, vec3 d, float tmin, float tmax) {
    float fall = falling(shape, d);
    float t = tmin;
    uint steps = 0;
    for (; steps < 300 && fall > 0.0; steps++) {
        float above = height_above(shape, o, d, t);
        if (abs(above) < 0.0015 * t || t > tmax) {
            break;
        }
        t += above / fall;
    }
    return HeightfieldHit(fall > 0.0 && t > tmin && t < tmax, t, steps);
}
// ANCHOR_END: lipschitz

// ANCHOR: crossing
// The step ahead of t within which the ground cannot hide a hill. Within a step s, what rises above a straight line and
// sinks again does so by no more than bend·s²/8, if no second derivative along the ray is larger than
// `bend`. Where that is less than the height's own rounding, 4u of where the ray is, it is no hill.
float blind_step(float bend, vec3 o, vec3 d, float t) {
    const float ROUNDING = 4.0 / 16777216.0;
    vec3 place = abs(o) + abs(t * d);
    float reach = max(max(place.x, place.y), place.z);
    float least = ROUNDING * reach / max(max(abs(d.x), abs(d.y)), abs(d.z));
    return max(sqrt(8.0 * ROUNDING * reach / max(bend, 1e-30)), least);
}

// Both parabolas of S bend by 32, and products of slopes are no larger than 8·8.
float bending(HeightfieldShape shape, vec3 d) {
    float f = abs(shape.fx) + abs(shape.fz);
    float g = abs(shape.gx) + abs(shape.gz);
    return 64.0 * abs(shape.k) * (abs(shape.a) * f * f + abs(shape.b) * g * g) * dot(d.xz, d.xz);
}

// The ray is above the ground at t.x, by heights.x, and not at t.y: the bracket closes on the crossing. A
// straight line guesses where; an end that stays twice counts half (the Illinois rule: Dowell and
// Jarratt, BIT 11, 1971), so that both ends move.
HeightfieldHit crossing_between(
    HeightfieldShape shape, vec3 o, vec3 d, vec2 t, vec2 heights, float side, uint steps) {
    for (uint i = 0; i < 60; i++) {
        float width = t.y - t.x;
        float least = 1.2e-7 * max(abs(t.x), abs(t.y));
        if (width <= 2.0 * least) {
            break;
        }
        // Every eighth time the middle, should the guesses be no good.
        float share = i % 8 == 7 ? 0.5 : heights.x / (heights.x - heights.y);
        float between = t.x + clamp(share * width, least, width - least);
        float above = side * height_above(shape, o, d, between);
        steps++;
        if (above > 0.0) {
            t.x = between;
            heights = vec2(above, 0.5 * heights.y);
        } else {
            t.y = between;
            heights = vec2(0.5 * heights.x, above);
        }
    }
    return HeightfieldHit(true, t.y, steps);
}
// ANCHOR_END: crossing

// Lipschitz steps until the ground is passed, which only a blind step can do; then the crossing (Hart,
// The Visual Computer 12, 1996). The march ends at a change of sign or at tmax, and nowhere else.
HeightfieldHit heightfield_bisected(HeightfieldShape shape, vec3 o, vec3 d, float tmin, float tmax) {
    float bend = bending(shape, d);
    float t = tmin;
    uint steps = 1;
    float above = height_above(shape, o, d, t);
    if (above == 0.0) {
        // On the ground, which is no hit: a step off it.
        t += blind_step(bend, o, d, t);
        above = height_above(shape, o, d, t);
        steps++;
    }
    // From below, everything is upside down.
    float side = above < 0.0 ? -1.0 : 1.0;
    above *= side;
    float fall = falling(shape, vec3(d.x, side * d.y, d.z));
    while (fall > 0.0 && t < tmax && steps < MARCH_LIMIT) {
        float next = min(t + max(above / fall, blind_step(bend, o, d, t)), tmax);
        float there = side * height_above(shape, o, d, next);
        steps++;
        if (there <= 0.0) {
            return crossing_between(shape, o, d, vec2(t, next), vec2(above, there), side, steps);
        }
        t = next;
        above = there;
    }
    return HeightfieldHit(false, t, steps);
}

// Longer steps, as if the ground were less steep (Keinert and others, Smart Tools and Applications in
// Graphics 2014). From the new place, too, some of the way back is free for sure; if the two free parts
// leave a gap, or the ground is passed, the step was too long: it is taken back for the safe one.
HeightfieldHit heightfield_over_relaxed(HeightfieldShape shape, vec3 o, vec3 d, float tmin, float tmax) {
    const float RELAXATION = 1.6;
    float bend = bending(shape, d);
    float t = tmin;
    uint steps = 1;
    float above = height_above(shape, o, d, t);
    if (above == 0.0) {
        t += blind_step(bend, o, d, t);
        above = height_above(shape, o, d, t);
        steps++;
    }
    float side = above < 0.0 ? -1.0 : 1.0;
    above *= side;
    float fall = falling(shape, vec3(d.x, side * d.y, d.z));
    float rise = falling(shape, vec3(d.x, -side * d.y, d.z));
    while (fall > 0.0 && t < tmax && steps < MARCH_LIMIT) {
        float safe = max(above / fall, blind_step(bend, o, d, t));
        float next = min(t + RELAXATION * safe, tmax);
        float there = side * height_above(shape, o, d, next);
        steps++;
        // Backwards from there, the ray comes down by no more than `rise`.
        if (there < rise * (next - t - safe)) {
            next = min(t + safe, tmax);
            there = side * height_above(shape, o, d, next);
            steps++;
        }
        if (there <= 0.0) {
            return crossing_between(shape, o, d, vec2(t, next), vec2(above, there), side, steps);
        }
        t = next;
        above = there;
    }
    return HeightfieldHit(false, t, steps);
}

HeightfieldHit heightfield_by(
    uint rung, HeightfieldShape shape, vec3 o, vec3 d, float tmin, float tmax) {
    switch (rung) {
        case HEIGHTFIELD_RELAXED: return heightfield_relaxed(shape, o, d, tmin, tmax);
        case HEIGHTFIELD_LIPSCHITZ: return heightfield_lipschitz(shape, o, d, tmin, tmax);
        case HEIGHTFIELD_SECANT: return heightfield_secant(shape, o, d, tmin, tmax);
        case HEIGHTFIELD_OVER_RELAXED: return heightfield_over_relaxed(shape, o, d, tmin, tmax);
        default: return heightfield_bisected(shape, o, d, tmin, tmax);
    }
}
