// Traced: the device has found the ray in the box around a shape, and asks whether it meets the shape.
#include "query.glsl"
#include "ask.glsl"

hitAttributeEXT vec3 normal;

#if PRIMITIVE == PRIMITIVE_SECONDARY_ORIGIN
// A ray that left a sphere: does it meet the same sphere, or the plane above it?
Answer ask_second(Query query) {
    uint first = query.first;
    Answer answer = Answer(1, 0, 0.0, vec3(0.0), vec3(0.0), 0);
    if (push.numbers.at[first] == 0.0) {
        vec3 center = vec3(push.numbers.at[first + 1], push.numbers.at[first + 2], push.numbers.at[first + 3]);
        precise vec3 f = query.origin - center;
        vec2 t;
        if (sphere_stable(f, query.direction, push.numbers.at[first + 4], t)) {
            answer.t = t.x > query.tmin ? t.x : t.y;
            answer.hit = answer.t > query.tmin && answer.t <= query.tmax ? 1 : 0;
        }
    } else {
        precise float t = (push.numbers.at[first + 14] - query.origin.y) / query.direction.y;
        answer.t = t;
        answer.hit = query.direction.y != 0.0 && t > query.tmin && t <= query.tmax ? 1 : 0;
    }
    return answer;
}
#endif

void main() {
    uint i = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
    Query query = push.queries.at[i];
    // All shapes stand in one world; each ray is asked about its own.
    if (gl_InstanceCustomIndexEXT != query.shape) {
        return;
    }
    push.answers.at[i].offered = 1;
    // The ray that the device traces, in the world: the way into the shape's space is part of the rung.
    query.origin = gl_WorldRayOriginEXT;
    query.direction = gl_WorldRayDirectionEXT;
    query.tmin = gl_RayTminEXT;
    query.tmax = gl_RayTmaxEXT;
#if PRIMITIVE == PRIMITIVE_SECONDARY_ORIGIN
    Answer answer = ask_second(query);
#else
    Answer answer = ask(query, push.numbers);
#endif
    if (answer.hit != 0) {
        normal = answer.normal;
        reportIntersectionEXT(answer.t, 0);
    }
}
