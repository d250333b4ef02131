// The next ray of a path: the plane first, then the scene as far as the plane.
//
// For shaders that have declared `tlas` and `payload`.

// ANCHOR: trace
void trace_path() {
    payload.plane = meet_plane(
        payload.origin, payload.direction, payload.tmin, FAR, payload.on_plane);
    traceRayEXT(
        tlas,
        gl_RayFlagsNoneEXT,
        0xff,                             // cull mask: every instance
        0,                                // sbtRecordOffset: the first hit record of the instance
        1,                                // sbtRecordStride: one record a geometry
        payload.plane < FAR ? 2 : 0,      // missIndex: who meets nothing else is at the plane
        payload.origin,
        payload.tmin,
        payload.direction,
        PLANE_TEST == PLANE_BEFORE ? payload.plane : FAR,   // tmax
        0                                 // payload location
    );
}
// ANCHOR_END: trace
