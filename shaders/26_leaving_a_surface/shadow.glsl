// The shadow ray.

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;

layout(location = 1) rayPayloadEXT bool lit;

bool is_lit(RayOrigin start, vec3 to_light) {
    // Any hit will do, and no shader needs to hear of it. No surface here has an any-hit shader.
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT
        | gl_RayFlagsOpaqueEXT;
    lit = false;
    traceRayEXT(
        tlas,
        flags,
        0xff,                       // cull mask: every instance
        0,                          // sbtRecordOffset: no hit shader runs
        1,                          // sbtRecordStride: one record per geometry
        1,                          // missIndex: shadow.rmiss
        start.origin,
        start.tmin,
        to_light,
        1e30,                       // tmax
        1                           // payload location
    );
    return lit;
}
