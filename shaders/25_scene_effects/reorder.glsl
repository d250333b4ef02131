// A ray between whose hit and hit shader threads may change places.
//
// The program defines REORDERING for a divergent scene, if the device has VK_EXT_ray_tracing_invocation_reorder.
// Arguments are those of traceRayEXT.
#ifdef REORDERING
#extension GL_EXT_shader_invocation_reorder : require
#define TRACE_RAY(tlas, flags, mask, offset, stride, miss, origin, tmin, direction, tmax, payload) { \
        hitObjectEXT met; \
        hitObjectTraceRayEXT(met, tlas, flags, mask, offset, stride, miss, origin, tmin, direction, tmax, payload); \
        /* Those whose rays met alike go on side by side. */ \
        reorderThreadEXT(met); \
        hitObjectExecuteShaderEXT(met, payload); \
    }
#else
#define TRACE_RAY traceRayEXT
#endif
