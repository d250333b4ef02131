// What happens at a surface, a triangle, the plane or a solid: light, shadow, the ray that goes on.

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;

layout(location = 0) rayPayloadInEXT Path payload;
layout(location = 1) rayPayloadEXT bool lit;

#include "trace.glsl"
#include "fog.glsl"

// ANCHOR: met
// What a ray has met.
struct Met {
    float t;
    vec3 position;
    vec3 normal;             // unit, towards the eye
    vec3 flat_normal;        // the same of the surface itself, not of its shading
    vec3 lift;               // of shadow rays, to the round surface that the triangles stand for
    vec3 up;                 // the normal that tells what is below the surface
    bool on_plane;
    float curvature;         // by how much the normal turns in a unit of length
    MaterialRecord material;
    vec3 reflection;         // what part of the light it mirrors when looked at straight
};

// Where a ray starts that leaves what was met. The shader that includes this file knows.
Start start_from(Met met, vec3 direction);
// ANCHOR_END: met

// ANCHOR: shadow
// Whether nothing lies between a point and a light, or a point of the light.
bool is_lit(Start ray, bool on_plane, Light light, vec3 to_light) {
    float tmin = ray.tmin / length(to_light);
    float plane = meet_plane(ray.origin, to_light, tmin, light_end(light), on_plane);
    if (PLANE_TEST == PLANE_BEFORE && plane < FAR) {
        return false;
    }
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
        ray.origin,
        tmin,
        to_light,
        light_end(light),           // tmax
        1                           // payload location
    );
    return lit && plane == FAR;
}
// ANCHOR_END: shadow

// ANCHOR: visibility
// What part of a light is seen, 0 to 1, by what was met. One ray tells if the light has no size.
float visibility(Met met, Light light) {
    if (push.shadow_rays == SHADOW_OFF) {
        return 1.0;
    }
    bool soft = light.size > 0.0;
    uint count = soft ? push.light_samples : 1;
    vec2 start = random(gl_LaunchIDEXT.xy, 0, payload.bounce, DIMENSION_LIGHT).xy;
    uint seen = 0;
    for (uint i = 0; i < count; i++) {
        vec2 point = soft ? disk_point(i, count, start) : vec2(0.0);
        vec3 to_light = towards_light(light, met.position + met.lift, point);
        Start ray = start_from(met, to_light);
        ray.origin += met.lift;
        // What is below the surface, the surface itself hides; that needs no ray.
        if (dot(met.up, to_light) > 0.0 && is_lit(ray, met.on_plane, light, to_light)) {
            seen++;
        }
    }
    return float(seen) / float(count);
}
// ANCHOR_END: visibility

// ANCHOR: fresnel
// What part of the light a polished surface reflects: `head_on` when looked at straight, and all of it
// at a grazing angle (Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994).
vec3 fresnel(vec3 head_on, float cosine) {
    float grazing = 1.0 - cosine;
    return head_on + (1.0 - head_on) * (grazing * grazing * grazing * grazing * grazing);
}
// ANCHOR_END: fresnel

// ANCHOR: mirrored
// Where a mirror sends a ray. Interpolated normals may send it into the triangle: it comes out again,
// mirrored at the triangle itself.
vec3 mirrored(vec3 direction, vec3 normal, vec3 up) {
    vec3 on = reflect(direction, normal);
    return normalize(on - 2.0 * min(dot(on, up), 0.0) * up);
}
// ANCHOR_END: mirrored

// Adds what is seen there, `identity` where `show` asks for the hit, and sends the path on.
void shade(Met met, vec4 identity, vec3 number) {
    // ANCHOR: mirror
    vec3 view = -gl_WorldRayDirectionEXT;
    vec3 mirror = met.reflection == vec3(0.0)
        ? vec3(0.0)
        : fresnel(met.reflection, max(dot(met.normal, view), 0.0));
    // What is reflected does not reach the colour below.
    vec3 base = met.material.base_color * (1.0 - mirror);
    // ANCHOR_END: mirror
    // ANCHOR: light
    vec3 origin = met.position + met.lift;
    vec3 color = met.material.emission + base * ambient(met.normal);
    float visible = 0.0;
    for (uint i = 0; i < push.world.light_count; i++) {
        Light lamp = push.world.lights[i];
        float part = visibility(met, lamp);
        vec3 light = normalize(towards_light(lamp, origin, vec2(0.0)));
        color += part * arriving_light(lamp, origin) * reflect_light(
            base, met.material.specular, met.material.shininess, met.normal, view, light);
        visible += part / float(push.world.light_count);
    }
    // ANCHOR_END: light
    // ANCHOR: fog
    float clear = clear_after(way_outside(met.t));
    color = mix(push.world.fog.color, color, clear);
    // ANCHOR_END: fog

    vec4 seen = vec4(color, 1.0);
    if (push.show == SHOW_NORMAL) {
        seen.rgb = 0.5 + 0.5 * met.normal;
    }
    if (push.show == SHOW_TRIANGLE) {
        seen.rgb = number;
    }
    if (push.show == SHOW_HIT) {
        seen = identity;
    }
    if (push.show == SHOW_DIRECTION) {
        seen = vec4(-view, met.t);
    }
    if (push.show == SHOW_SHADOW) {
        seen.rgb = vec3(visible);
    }
    if (push.show == SHOW_SHADOW_ORIGIN) {
        vec3 to_light = normalize(towards_light(push.world.lights[0], origin, vec2(0.0)));
        seen = vec4(start_from(met, to_light).origin + met.lift, visible);
    }
    if (push.show == SHOW_RAY_ORIGIN) {
        seen = vec4(gl_WorldRayOriginEXT, gl_RayTminEXT);
    }
    if (push.show == SHOW_FOG) {
        seen = vec4(way_outside(met.t), clear, met.t, 1.0);
    }

    // ANCHOR: bounce
    gather(payload, seen);
    payload.throughput *= mirror * clear;
    payload.direction = mirrored(-view, met.normal, met.flat_normal);
    Start ray = start_from(met, payload.direction);
    payload.origin = ray.origin;
    payload.tmin = ray.tmin;
    payload.on_plane = met.on_plane;
    // A curved mirror turns what comes along the cone's sides apart, by twice the angle of its normals.
    payload.width += payload.spread * met.t;
    payload.spread += 2.0 * met.curvature * payload.width;
    payload.bounce++;
    if (METHOD == METHOD_RECURSIVE && goes_on(payload)) {
        trace_path();
    }
    // ANCHOR_END: bounce
}
