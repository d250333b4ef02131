// What follows a hit of any kind: light, shadow, and the payload.
#include "common/offset.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;

layout(location = 0) rayPayloadInEXT vec4 payload;
layout(location = 1) rayPayloadEXT bool lit;

// ANCHOR: shadow
// Whether nothing lies between a point and the light, or a point of the light.
bool is_lit(vec3 origin, vec3 to_light) {
    // Any hit will do, and no shader needs to hear of it. No surface here asks an any-hit shader.
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT
        | gl_RayFlagsOpaqueEXT;
    if (push.shadow_rays == SHADOW_NEAREST_HIT) {
        flags &= ~gl_RayFlagsTerminateOnFirstHitEXT;
    }
    lit = false;
    traceRayEXT(
        tlas,
        flags,
        0xff,                       // cull mask: every instance
        0,                          // sbtRecordOffset: no hit shader runs
        1,                          // sbtRecordStride: one record a geometry
        1,                          // missIndex: shadow.rmiss
        origin,
        0.0,                        // tmin: the origin lies off the surface
        to_light,
        light_end(push.light),      // tmax
        1                           // payload location
    );
    return lit;
}
// ANCHOR_END: shadow

// ANCHOR: visibility
// What part of the light is seen, 0 to 1, by a surface whose normal is `up`. One ray tells if the light
// has no size.
float visibility(vec3 origin, vec3 up) {
    if (push.shadow_rays == SHADOW_OFF) {
        return 1.0;
    }
    bool soft = push.light.size > 0.0;
    uint count = soft ? push.light_samples : 1;
    vec2 start = random(gl_LaunchIDEXT.xy, 0, 0, DIMENSION_LIGHT).xy;
    uint seen = 0;
    for (uint i = 0; i < count; i++) {
        vec2 point = soft ? disk_point(i, count, start) : vec2(0.0);
        vec3 to_light = towards_light(push.light, origin, point);
        // What is below the surface, the surface itself hides; that needs no ray.
        if (dot(up, to_light) > 0.0 && is_lit(origin, to_light)) {
            seen++;
        }
    }
    return float(seen) / float(count);
}
// ANCHOR_END: visibility

// Fills the payload. `origin` is where rays may leave the surface, `up` its side; both in the world.
void show_surface(
    uint primitive, MaterialRecord material, vec3 base, vec3 normal, vec3 origin, vec3 up
) {
    // Taken down before a shadow ray is traced: afterwards the software driver takes these for that
    // ray's own.
    vec3 view = -gl_WorldRayDirectionEXT;
    vec4 hit = vec4(gl_InstanceCustomIndexEXT, primitive, gl_HitTEXT, gl_InstanceID);
    uint kind = gl_HitKindEXT;
    float visible = visibility(origin, up);
    vec3 light = normalize(towards_light(push.light, origin, vec2(0.0)));
    vec3 color = material.emission + base * ambient(normal);
    color += visible * arriving_light(push.light, origin)
        * reflect_light(base, material.specular, material.shininess, normal, view, light);

    payload = vec4(color, 1.0);
    if (push.show == SHOW_NORMAL) {
        payload.rgb = 0.5 + 0.5 * normal;
    }
    if (push.show == SHOW_TRIANGLE) {
        payload.rgb = false_color(primitive);
    }
    if (push.show == SHOW_HIT) {
        payload = hit;
    }
    if (push.show == SHOW_DIRECTION) {
        payload = vec4(-view, hit.z);
    }
    if (push.show == SHOW_SHADOW) {
        payload.rgb = vec3(visible);
    }
    if (push.show == SHOW_ORIGIN) {
        payload = vec4(origin, visible);
    }
    if (push.show == SHOW_KIND) {
        payload = vec4(false_color(kind), kind);
    }
}
