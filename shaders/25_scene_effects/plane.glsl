// The plane: where a ray meets it, and what it reports there.
#include "ray.glsl"
#include "squares.glsl"

// Where a ray meets the plane, FAR if it does not. A line meets a plane once: a ray that leaves it has
// nothing to ask, and needs no offset.
float meet_plane(vec3 origin, vec3 direction, float end, bool on_plane) {
    float t;
    if (push.world.plane_on == 0 || on_plane
        || !plane_compensated(push.world.plane, origin, direction, t)) {
        return FAR;
    }
    return t > 0.0 && t < end ? t : FAR;
}

// The plane at the distance t of a ray, reported as a hit shader reports a triangle.
Hit hit_of_plane(Ray ray, float t) {
    Plane plane = push.world.plane;
    Board board = push.world.board;
    vec3 outward = normalize(plane.normal);
    // From the anchor, near the camera, and onto the plane, which rounding has left.
    precise vec3 from_anchor = ray.origin - plane.anchor + t * ray.direction;
    from_anchor -= (dot(from_anchor, plane.normal) - plane.rest)
        / dot(plane.normal, plane.normal) * plane.normal;
    vec2 middle = vec2(dot(from_anchor, board.u), dot(from_anchor, board.v)) / board.square;
    vec2 width = footprint(ray, t, outward, board.u, board.v) / board.square;

    Hit hit;
    hit.position = plane.anchor + from_anchor;
    hit.t = t;
    hit.normal = dot(ray.direction, plane.normal) > 0.0 ? -outward : outward;
    hit.material = MATERIAL_PLANE;
    hit.color = mix(board.dark, board.light, checker_light(board.anchor + middle, width));
#ifdef DEPARTURES
    hit.offset = 0.0;   // a ray that leaves the plane is not tested against it
    hit.face = hit.normal;
#endif
#ifdef TERMINATOR
    hit.terminator_offset = vec3(0.0);
#endif
#ifdef CHANCES
    hit.emitter = NO_EMITTER;
#endif
#ifdef CURVES
    hit.curvature = 0.0;
#endif
#ifdef EFFECT_HISTORY
    hit.surface = SURFACE_PLANE << 16;
#endif
    return hit;
}
