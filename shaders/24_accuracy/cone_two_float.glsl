// A ray against a cone between two discs in two-floats: where cone.glsl ends.
//
// Signs decide which parts a line meets, and they come from the line's moment m = f × d, which is the same wherever on
// the line f is. So the distance of the origin costs no bit, and a tangent, a rim and an apex of small whole numbers are
// exact. Where the line meets the parts is computed near the cone.
#include "common/two_float.glsl"

const uint CONE_TWO_FLOAT = 2;

// In units of the cone: whatever is farther away along the line than 2^60 is beyond both its ends.
const float FAR_AWAY = 1152921504606846976.0;

// The sum a² + b² + c² - d², rounded once.
vec2 squares(TwoFloat3 a, vec2 d) {
    vec3 sum = vec3(0.0);
    sum_add_product(sum, a.x, a.x);
    sum_add_product(sum, a.y, a.y);
    sum_add_product(sum, a.z, a.z);
    sum_add_product(sum, d, -d);
    return sum_total(sum);
}

// a·b - c·d, rounded once.
vec2 products(vec2 a, vec2 b, vec2 c, vec2 d) {
    vec3 sum = vec3(0.0);
    sum_add_product(sum, a, b);
    sum_add_product(sum, c, -d);
    return sum_total(sum);
}

vec2 moved(vec2 start, vec2 t, float d) {
    vec3 sum = vec3(start, 0.0);
    sum_add_product(sum, t, d);
    return sum_total(sum);
}

TwoFloat3 moved(TwoFloat3 start, vec2 t, vec3 d) {
    return TwoFloat3(moved(start.x, t, d.x), moved(start.y, t, d.y), moved(start.z, t, d.z));
}

// ANCHOR: chord
// The part of a line on which (u·u)·|p × u|² <= g, g >= 0: a chord, or half of the line, or all of it.
struct Chord {
    bool exists;
    bool has_first;   // whether it begins at `first`, and ends at `last`
    bool has_last;
    vec2 first;
    vec2 last;
    vec2 middle;      // of a chord
    bool is_point;
};

// True if the chord is farther along the line than x, which is not on it.
bool is_beyond(Chord chord, vec2 x) {
    return chord.has_first && (!chord.has_last || ff_less(x, chord.middle));
}

// The roots of a·x² + 2b·x + c, with a discriminant from better numbers. For a < 0 the line runs through the cone and its
// mirror image, and between the two it is outside; the cone is where g grows.
Chord chord_of(vec2 a, vec2 b, vec2 c, vec2 discriminant, float rate, float rim) {
    Chord chord = Chord(true, false, false, vec2(0.0), vec2(0.0), vec2(0.0), false);
    if (a.x == 0.0 && discriminant.x == 0.0) {
        // Along the axis of a cylinder, or along the side: the line is everywhere as far inside as in the plane of a disc.
        chord.exists = rim <= 0.0;
        return chord;
    }
    if (a.x > 0.0 && discriminant.x < 0.0) {
        chord.exists = false;
        return chord;
    }
    vec2 root = ff_sqrt(discriminant);
    vec2 q = b.x > 0.0 ? -ff_add(b, root) : ff_sub(root, b);
    vec2 small = q.x != 0.0 ? ff_div(c, q) : vec2(0.0);
    vec2 large = a.x != 0.0 ? ff_div(q, a) : small;
    chord.is_point = a.x > 0.0 && discriminant.x == 0.0;
    if (chord.is_point) {
        small = large;
    }
    bool swaps = ff_less(large, small);
    chord.first = swaps ? large : small;
    chord.last = swaps ? small : large;
    bool is_from = a.x == 0.0 ? b.x < 0.0 : rate > 0.0;
    if (a.x > 0.0) {
        chord.has_first = true;
        chord.has_last = true;
        chord.middle = ff_div(-b, a);
    } else if (is_from) {
        chord.has_first = true;
        chord.first = chord.last;
    } else {
        chord.has_last = true;
        chord.last = chord.first;
    }
    return chord;
}
// ANCHOR_END: chord

bool cone_two_float(vec3 o, vec3 d, float tmin, float tmax, Cone cone, out Meeting m, out vec3 normal) {
    m = Meeting(0, 0.0, PART_SIDE);
    normal = vec3(0.0);
    // The narrow end first: then g is a sum of positive numbers everywhere between the discs.
    if (cone.rb < cone.ra) {
        cone = Cone(cone.b, cone.a, cone.rb, cone.ra, cone.closed);
    }
    TwoFloat3 f[2] = TwoFloat3[2](ff_difference(o, cone.a), ff_difference(o, cone.b));
    TwoFloat3 u = ff_difference(cone.b, cone.a);
    int size = max(exponent_of(cone.rb), exponent_of(rounded(u)));
    size = max(size, exponent_of(rounded(f[0])) - 40);
    int speed = exponent_of(d);
    d = scaled(d, -speed);
    // The axis is only a direction, of a length near 1: a cone may be as flat as a coin.
    int flatness = exponent_of(rounded(u)) - size;
    vec3 half_axis = 0.5 * rounded(scaled(u, -size));
    u = scaled(u, -size - flatness);
    float radius[2] = float[2](scaled(cone.ra, -size), scaled(cone.rb, -size));
    vec2 uu = ff_dot(u, u);
    vec2 ud = ff_dot(u, d);
    vec2 k = scaled(two_sum(radius[1], -radius[0]), -flatness);
    TwoFloat3 e = ff_cross(u, -d);

    // rim: the square of the distance between line and axis in the plane of a disc, less that of the radius.
    float rim[2];
    vec2 at[2];
    vec2 height = vec2(0.0);
    vec2 beside = vec2(0.0);
    TwoFloat3 foot;
    for (int i = 1; i >= 0; i--) {
        TwoFloat3 from = scaled(f[i], -size);
        TwoFloat3 moment = ff_cross(from, d);
        foot = ff_cross(u, moment);
        rim[i] = squares(foot, ff_mul(ud, radius[i])).x;
        height = ff_dot(from, u);
        at[i] = abs(height.x) > FAR_AWAY * abs(ud.x) ? vec2(height.x * ud.x > 0.0 ? -FAR_AWAY : FAR_AWAY, 0.0)
                                                     : ff_div(-height, ud);
        beside = ff_dot(u, moment);
    }
    TwoFloat3 tilt = ff_cross(foot, u);
    vec2 wide = ff_mul(uu, radius[0]);
    TwoFloat3 v = TwoFloat3(
        products(wide, e.x, k, tilt.x), products(wide, e.y, k, tilt.y), products(wide, e.z, k, tilt.z));
    vec2 discriminant = ff_mul(uu, squares(v, ff_mul(uu, beside)));

    // The origin moves to the middle of the cone, in two steps: the second is what the first lacks.
    TwoFloat3 near = scaled(f[0], -size);
    precise float step = dot(half_axis - rounded(near), d) / dot(d, d);
    TwoFloat3 w = moved(near, vec2(step, 0.0), d);
    precise float rest = dot(half_axis - rounded(w), d) / dot(d, d);
    vec2 start = two_sum(step, rest);
    w = moved(near, start, d);
    TwoFloat3 across = ff_cross(w, u);
    vec2 g = ff_add(wide, ff_mul(k, ff_dot(w, u)));
    vec2 rate = ff_mul(k, ud);
    vec2 a = products(uu, ff_dot(e, e), rate, rate);
    vec2 b = products(uu, ff_dot(across, e), g, rate);
    vec2 c = products(uu, ff_dot(across, across), g, g);
    Chord chord = chord_of(a, b, c, discriminant, rate.x, rim[0]);
    if (!chord.exists) {
        return false;
    }

    // Where the line is between the discs. A line along them has no place where it comes or goes.
    bool is_level = ud.x == 0.0;
    int comes = ud.x > 0.0 ? 0 : 1;
    float rim_in = is_level ? 1.0 : rim[comes];
    float rim_out = is_level ? 1.0 : rim[1 - comes];
    vec2 in_at = ff_sub(at[comes], start);
    vec2 out_at = ff_sub(at[1 - comes], start);
    bool is_past_in = is_level || is_beyond(chord, in_at);
    bool is_past_out = !is_level && is_beyond(chord, out_at);
    if (is_level && (height.x < 0.0 || ff_less(scaled(uu, flatness), height))) {
        return false;
    }
    if ((rim_in > 0.0 && !is_past_in) || (rim_out > 0.0 && is_past_out)) {
        return false;
    }
    bool is_chord = chord.has_first && chord.has_last;
    vec2 points[2];
    bool counts[2];
    bool on_disc[2] = bool[2](false, false);
    // A line through a rim meets disc and side at once. Signs tell at which end of the chord.
    bool in_is_last = rim_in == 0.0 && chord.has_last && (!is_chord || ff_less(chord.middle, in_at));
    bool out_is_first = rim_out == 0.0 && chord.has_first && (!is_chord || ff_less(out_at, chord.middle));
    if (cone.closed) {
        on_disc[0] = rim_in <= 0.0;
        on_disc[1] = rim_out <= 0.0;
        counts[0] = true;
        counts[1] = !in_is_last && !out_is_first && !(chord.is_point && is_chord);
    } else {
        bool in_is_first = rim_in == 0.0 && (!is_chord || !ff_less(chord.middle, in_at));
        bool out_is_last = rim_out == 0.0 && (!is_chord || !ff_less(out_at, chord.middle));
        counts[0] = chord.has_first && (rim_in > 0.0 || in_is_first);
        counts[1] = chord.has_last && (rim_out > 0.0 || out_is_last) && !(chord.is_point && counts[0]);
    }
    points[0] = on_disc[0] ? at[comes] : ff_add(start, chord.first);
    points[1] = on_disc[1] ? at[1 - comes] : ff_add(start, chord.last);
    int met = 0;
    for (int i = 1; i >= 0; i--) {
        vec2 t = scaled(points[i], size - speed);
        if (counts[i] && ff_within(t, tmin, tmax)) {
            m.count++;
            m.t = t.x;
            met = i;
            m.part = !on_disc[i] ? PART_SIDE : (i == 0) == (comes == 0) ? PART_A : PART_B;
        }
    }
    if (m.count == 0) {
        return false;
    }
    TwoFloat3 outward = u;
    bool is_up = m.part == PART_B;
    if (m.part == PART_SIDE) {
        vec2 x = met == 0 ? chord.first : chord.last;
        TwoFloat3 there = TwoFloat3(ff_add(across.x, ff_mul(e.x, x)), ff_add(across.y, ff_mul(e.y, x)),
            ff_add(across.z, ff_mul(e.z, x)));
        vec2 along = ff_mul(ff_add(g, ff_mul(x, rate)), k);
        TwoFloat3 out_of = ff_cross(u, there);
        outward = TwoFloat3(products(uu, out_of.x, along, u.x), products(uu, out_of.y, along, u.y),
            products(uu, out_of.z, along, u.z));
        is_up = rounded(outward) != vec3(0.0);
        if (!is_up) {
            // At an apex there is no normal, and the axis is as good as any.
            outward = u;
        }
    }
    normal = ff_normalize(outward);
    normal = is_up ? normal : -normal;
    return true;
}
