// Traced: the ray goes through the device's acceleration structure.
#include "query.glsl"
#include "ask.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;

layout(location = 0) rayPayloadEXT Answer payload;

void main() {
    uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
    if (i >= push.count) {
        return;
    }
    Query query = push.queries.at[i];
    vec3 point = vec3(0.0);
#if PRIMITIVE == PRIMITIVE_SECONDARY_ORIGIN
    // The rung says where the ray starts; what is traced is the ray that leaves.
    point = ask(query, push.numbers).point;
    uint first = query.first + 11;
    query.origin = point;
    query.direction = vec3(push.numbers.at[first], push.numbers.at[first + 1], push.numbers.at[first + 2]);
    query.tmin = RUNG == ORIGIN_TMIN ? 1e-4 / length(query.direction) : 0.0;
    query.tmax = 1e30;
#endif
    push.answers.at[i].offered = 0;
    payload = Answer(0, 0, 0.0, vec3(0.0), vec3(0.0), 0);
    traceRayEXT(
        tlas,
        gl_RayFlagsNoneEXT,
        0xff,                // cull mask: every instance
        0,                   // sbtRecordOffset
        0,                   // sbtRecordStride: one record for all
        0,                   // missIndex: nothing.rmiss
        query.origin,
        query.tmin,
        query.direction,
        query.tmax,
        0                    // payload location
    );
    push.answers.at[i].hit = payload.hit;
    push.answers.at[i].t = payload.t;
    push.answers.at[i].normal = payload.normal;
    push.answers.at[i].point = point;
    push.answers.at[i].count = 0;
}
