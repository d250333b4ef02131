// Where a ray meets the plane.

// As far as rays go.
const float FAR = 1e30;

// Whether the path has met the plane last, so that its next rays leave the plane.
bool on_plane = false;

// Where a ray meets the plane, FAR if it does not. A line meets a plane once: a ray that leaves it has
// nothing to ask, and needs no offset.
float meet_plane(vec3 origin, vec3 direction, float end) {
    Plane plane = push.world.plane;
    float t;
    if (!HAS_PLANE || on_plane || !plane_by(PLANE_RUNG, plane, origin, direction, t)) {
        return FAR;
    }
    bool passes = INSIDE == INSIDE_THROUGH && dot(direction, plane.normal) > 0.0;
    return t > 0.0 && t < end && !passes ? t : FAR;
}

// Where each rung finds the plane; -1 where it does not.
vec4 by_every_rung(vec3 origin, vec3 direction) {
    vec4 found;
    for (uint rung = PLANE_POV; rung <= PLANE_COMPENSATED; rung++) {
        float t;
        bool met = plane_by(rung, push.world.plane, origin, direction, t);
        found[rung] = met && t > 0.0 && t < FAR ? t : -1.0;
    }
    return found;
}
