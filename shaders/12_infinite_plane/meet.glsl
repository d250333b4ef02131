// Meeting the plane.

// As far as rays go.
const float FAR = 1e30;

// ANCHOR: meet_plane
// Set while the path is on the plane, so that its next rays leave the plane.
bool on_plane = false;

// The distance at which a ray meets the plane; FAR if it does not. A line meets a plane once, so a ray that
// leaves it is not tested, and needs no offset.
float meet_plane(vec3 origin, vec3 direction, float end) {
    Plane plane = push.world.plane;
    float t;
    if (!HAS_PLANE || on_plane || !plane_compensated(plane, origin, direction, t)) {
        return FAR;
    }
    bool passes = INSIDE == INSIDE_THROUGH && dot(direction, plane.normal) > 0.0;
    return t > 0.0 && t < end && !passes ? t : FAR;
}
// ANCHOR_END: meet_plane
