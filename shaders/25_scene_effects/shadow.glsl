// The shadow ray: the plane first, then the scene.

layout(location = 1) rayPayloadEXT bool lit;

bool is_lit(vec3 origin, vec3 to_light, float end, bool on_plane) {
#ifdef EFFECT_PLANE
    if (meet_plane(origin, to_light, end, on_plane) < FAR) {
        return false;
    }
#endif
    lit = false;
    traceRayEXT(
        tlas,
        // Any hit will do, and no shader needs to hear of it.
        RAY_FLAGS | gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT,
        RAY_MASK,       // cull mask: the kinds of geometry that there are shaders for
        0,              // sbtRecordOffset: the first hit record of the instance
        1,              // sbtRecordStride: one record per geometry
        1,              // missIndex: shadow.rmiss
        origin,
        tmin,           // 0, or the time: the origin lies off the surface
        to_light,
        end,            // tmax
        1               // payload location
    );
    return lit;
}
