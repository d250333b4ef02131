// A solid along a ray: between which t each convex part holds it, and where what they make together
// begins and ends.
//
// For shaders that have included push.glsl.
#include "common/sphere.glsl"

// Beyond every t.
const float NOWHERE = 3e38;

// A point (w = 1) or a direction (w = 0) of the world in the solid's own space.
vec3 in_space_of(SolidRecord solid, vec4 v) {
    return vec3(dot(solid.to_object[0], v), dot(solid.to_object[1], v), dot(solid.to_object[2], v));
}

// The depth of a point below a plane, times |N|, and the speed at which a ray rises to it.
float height_below(Plane plane, vec3 o) {
    switch (RUNG) {
        case RUNG_POV: {
            precise float height = plane.distance.x - dot(o, plane.normal);
            return height;
        }
        case RUNG_COMPENSATED:
            return dot_compensated(plane.distance, -o, plane.normal);
        default: {
            precise vec3 to_plane = plane.anchor - o;
            precise float height = dot(to_plane, plane.normal) + plane.rest;
            return height;
        }
    }
}

float slope_to(Plane plane, vec3 d) {
    precise float slope = dot(d, plane.normal);
    return RUNG == RUNG_COMPENSATED ? dot_compensated(vec2(0.0), d, plane.normal) : slope;
}

// True if a point is on the inner side. A point on the plane itself counts as just above it, along the
// stored normal: of two solids that touch there, exactly one holds it.
bool is_inner(Plane plane, float side, vec3 o) {
    return side > 0.0 ? height_below(plane, o) > 0.0 : height_below(plane, o) <= 0.0;
}

// Between which t a ray is on the inner side of a plane. A parallel ray is there always or never.
vec2 in_half_space(Plane plane, float side, vec3 o, vec3 d) {
    float slope = slope_to(plane, d);
    if (slope == 0.0) {
        return is_inner(plane, side, o) ? vec2(-NOWHERE, NOWHERE) : vec2(NOWHERE, -NOWHERE);
    }
    precise float quotient = height_below(plane, o) / slope;
    float t = clamp(quotient, -NOWHERE, NOWHERE);
    return slope * side > 0.0 ? vec2(-NOWHERE, t) : vec2(t, NOWHERE);
}

// Between which t a ray is in a ball.
vec2 in_ball(Ball ball, vec3 o, vec3 d) {
    precise vec3 f = o - ball.center;
    vec2 t;
    return sphere_stable(f, d, ball.radius, t) ? t : vec2(NOWHERE, -NOWHERE);
}

// ANCHOR: interval
// The interval of t where a ray is in a convex part, and the faces through which it enters and leaves.
struct Interval {
    float enter;
    float leave;
    uint enter_face;
    uint leave_face;
};

// The interval inside all bounds of the part: from the last one entered to the first one left.
Interval in_part(Part part, vec3 o, vec3 d) {
    Interval inside = Interval(-NOWHERE, NOWHERE, 0, 0);
    for (uint i = part.first_face; i < part.first_face + part.face_count; i++) {
        Face face = push.solids.faces.at[i];
        vec2 t;
        if (face.kind == FACE_BALL) {
            t = in_ball(push.solids.balls.at[face.index], o, d);
        } else {
            t = in_half_space(push.solids.planes.at[face.index], face.side, o, d);
        }
        if (t.x > inside.enter) {
            inside.enter = t.x;
            inside.enter_face = i;
        }
        if (t.y < inside.leave) {
            inside.leave = t.y;
            inside.leave_face = i;
        }
    }
    return inside;
}
// ANCHOR_END: interval

// Tests whether the solid contains a point, given the parts that contain it: bit i is part i. The program is in
// postfix order, and its stack is the bits of a number.
bool holds(SolidRecord solid, uint members) {
    uint stack = 0;
    for (uint i = solid.first_step; i < solid.first_step + solid.step_count; i++) {
        uint step = push.solids.steps.at[i];
        if (step < STEP_UNION) {
            stack = stack << 1 | (members >> step & 1);
        } else if (step == STEP_INVERSE) {
            stack ^= 1;
        } else {
            uint second = stack & 1;
            stack >>= 1;
            stack = step == STEP_UNION        ? stack | second
                  : step == STEP_INTERSECTION ? stack & (second | ~1u)
                                              : stack & ~second;
        }
    }
    return (stack & 1) != 0;
}

// True if a convex part holds a point: it is below every face.
bool part_holds(Part part, vec3 point) {
    bool within = true;
    for (uint i = part.first_face; i < part.first_face + part.face_count && within; i++) {
        Face face = push.solids.faces.at[i];
        if (face.kind == FACE_BALL) {
            Ball ball = push.solids.balls.at[face.index];
            within = distance(point, ball.center) < ball.radius;
        } else {
            within = is_inner(push.solids.planes.at[face.index], face.side, point);
        }
    }
    return within;
}

// True if a solid holds a point, by the same program.
bool contains(SolidRecord solid, vec3 point) {
    // Apart from the loop below: where one loop took the clip or a part, Mesa 26.2.6 crashed.
    if (solid.clip != NO_CLIP && !part_holds(push.solids.parts.at[solid.clip], point)) {
        return false;
    }
    uint members = 0;
    for (uint i = 0; i < solid.part_count; i++) {
        bool within = part_holds(push.solids.parts.at[solid.first_part + i], point);
        members |= within ? 1u << i : 0u;
    }
    return holds(solid, members);
}

// A solid's parts along a ray: from where to where the ray is in each. Parts that it never meets have none.
Interval intervals[MAX_PARTS];
uint parts[MAX_PARTS];
uint interval_count;

void follow(SolidRecord solid, vec3 o, vec3 d, float tmin, float tmax) {
    interval_count = 0;
    for (uint i = 0; i < solid.part_count; i++) {
        Interval interval = in_part(push.solids.parts.at[solid.first_part + i], o, d);
        if (interval.enter < interval.leave && interval.leave > tmin && interval.enter <= tmax) {
            intervals[interval_count] = interval;
            parts[interval_count++] = i;
        }
    }
}

// The next t at which a part is entered or left.
float change_after(float t) {
    float next = NOWHERE;
    // Unrolled for every element of the array, this loop takes more registers than some GPUs have.
    [[dont_unroll]] for (uint i = 0; i < interval_count; i++) {
        next = intervals[i].enter > t ? min(next, intervals[i].enter) : next;
        next = intervals[i].leave > t ? min(next, intervals[i].leave) : next;
    }
    return next;
}

// In which parts the ray is just before t, and just after.
uint members_before(float t) {
    uint members = 0;
    [[dont_unroll]] for (uint i = 0; i < interval_count; i++) {
        members |= intervals[i].enter < t && t <= intervals[i].leave ? 1u << parts[i] : 0u;
    }
    return members;
}

uint members_after(float t) {
    uint members = 0;
    [[dont_unroll]] for (uint i = 0; i < interval_count; i++) {
        members |= intervals[i].enter <= t && t < intervals[i].leave ? 1u << parts[i] : 0u;
    }
    return members;
}

// Between which t the solid's clip leaves it.
Interval in_clip(SolidRecord solid, vec3 o, vec3 d) {
    return solid.clip == NO_CLIP
        ? Interval(-NOWHERE, NOWHERE, 0, 0)
        : in_part(push.solids.parts.at[solid.clip], o, d);
}

// Where a ray goes through a solid's surface.
struct Crossing {
    float t;
    uint part;
    uint face;
    bool enters;
};

// The first t after tmin where the ray enters or leaves the solid.
bool first_crossing(SolidRecord solid, vec3 o, vec3 d, float tmin, float tmax, out Crossing found) {
    follow(solid, o, d, tmin, tmax);
    Interval clip = in_clip(solid, o, d);
    for (float t = change_after(tmin); t <= tmax && t < NOWHERE; t = change_after(t)) {
        // All changes at one t happen at once, so only the bits just before and just after it count.
        uint before = members_before(t);
        uint after = members_after(t);
        bool was_in = holds(solid, before);
        if (was_in == holds(solid, after) || t < clip.enter || t > clip.leave) {
            continue;
        }
        // Undo the changes, one part at a time: the part that restores the old result has the face.
        // Where a cutter only touches the solid, the face is the solid's, not the cutter's.
        uint members = after;
        for (uint i = 0; i < interval_count; i++) {
            uint part = 1u << parts[i];
            members ^= (before ^ after) & part;
            if (holds(solid, members) == was_in) {
                bool comes = (after & part) != 0;
                uint face = comes ? intervals[i].enter_face : intervals[i].leave_face;
                found = Crossing(t, parts[i], face, !was_in);
                return true;
            }
        }
    }
    return false;
}
