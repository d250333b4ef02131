// The log of a pixel that is traced alone. One invocation follows the other, so the entries are in the order
// of time. The first word counts the words after it.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RayLog { uint at[]; };

RayLog ray_log() {
    return RayLog(uvec2(RAY_LOG_LOW, RAY_LOG_HIGH));
}

uint log_end;

void log_word(uint word) {
    if (log_end <= RAY_LOG_WORDS) {
        ray_log().at[log_end] = word;
    }
    log_end++;
}

void log_words(vec3 numbers) {
    for (int i = 0; i < 3; i++) {
        log_word(floatBitsToUint(numbers[i]));
    }
}

// Begins an entry of so many words: its kind, and which shader writes it.
void log_entry(uint kind, uint words) {
    log_end = 1 + atomicAdd(ray_log().at[0], words + 1);
    log_word(kind | RAY_LOG_STAGE << 8);
}

void log_print() {
    log_entry(LOG_PRINT, 0);
}

#ifdef LOG_TRACES
// The ray, once: an argument may be a call with an effect.
uint log_flags, log_mask, log_offset, log_stride, log_miss;
vec3 log_origin, log_direction;
float log_tmin, log_tmax;

void log_ray(uint flags, uint mask, uint offset, uint stride, uint miss, vec3 origin, float tmin, vec3 direction,
        float tmax, uint payload) {
    log_flags = flags;
    log_mask = mask;
    log_offset = offset;
    log_stride = stride;
    log_miss = miss;
    log_origin = origin;
    log_tmin = tmin;
    log_direction = direction;
    log_tmax = tmax;
    if (gl_LaunchSizeEXT != uvec3(1)) {
        log_entry(LOG_MANY, 0);
        return;
    }
    log_entry(LOG_RAY, 14);
    log_word(payload);
    log_word(flags);
    log_word(mask);
    log_word(offset);
    log_word(stride);
    log_word(miss);
    log_words(origin);
    log_words(direction);
    log_word(floatBitsToUint(tmin));
    log_word(floatBitsToUint(tmax));
}

void log_back() {
    log_entry(LOG_BACK, 0);
}

#define traceRayEXT(tlas, flags, mask, offset, stride, miss, origin, tmin, direction, tmax, payload) \
    (log_ray(flags, mask, offset, stride, miss, origin, tmin, direction, tmax, payload), \
    traceRayEXT(tlas, log_flags, log_mask, log_offset, log_stride, log_miss, log_origin, log_tmin, \
        log_direction, log_tmax, payload), log_back())
#endif

#ifdef LOG_SURFACES
void log_met() {
    log_entry(LOG_SURFACES, 6);
    log_word(floatBitsToUint(gl_HitTEXT));
    log_word(gl_InstanceID);
    log_word(gl_InstanceCustomIndexEXT);
    log_word(gl_GeometryIndexEXT);
    log_word(gl_PrimitiveID);
    log_word(gl_HitKindEXT);
}
#endif

#ifdef LOG_MISSES
void log_met() {
    log_entry(LOG_MISS, 0);
}
#endif

#undef PRINT
#define PRINT(format, value) (log_print(), debugPrintfEXT(format, value))
