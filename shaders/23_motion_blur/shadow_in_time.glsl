// Like common/shadow.glsl in 05_shadow_miss, but the ray has the time of its sample.

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;

// The time of the sample that is traced.
float now;

layout(location = 1) rayPayloadEXT bool lit;

bool is_lit(vec3 origin, vec3 to_light, float end) {
    // Any hit will do, and no shader needs to hear of it. No surface here has an any-hit shader.
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT
        | gl_RayFlagsOpaqueEXT;
    lit = false;
    traceRayEXT(
        tlas,
        flags,
        mask_of(now),               // cull mask: what stands, and what moves as it is now
        0,                          // sbtRecordOffset: no closest hit shader runs
        1,                          // sbtRecordStride: one record per geometry
        1,                          // missIndex: shadow.rmiss
        origin,
        tmin_of(now),            // tmin: the time
        to_light,
        end,                        // tmax
        1                           // payload location
    );
    return lit;
}
