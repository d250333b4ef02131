// What happens at a surface of any kind: light, shadow, the ray that goes on.
#include "common/start.glsl"

layout(location = 0) rayPayloadInEXT Path payload;

#ifdef SHADOWS
layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
layout(location = 1) rayPayloadEXT bool lit;
#endif

// ANCHOR: met
// What a ray has met.
struct Met {
    float t;
    vec3 position;
    vec3 normal;         // unit, towards the eye
    vec3 flat_normal;    // the same of the surface itself, not of its shading
    vec3 lift;           // of shadow rays alone, to the round surface that triangles stand for
    vec3 up;             // the normal that tells what is below the surface
    bool on_plane;
    float curvature;     // by how much the normal turns in a unit of length
    vec3 base_color;
    vec3 specular;
    float shininess;
    vec3 emission;
    vec3 reflection;     // what part of the light it mirrors when looked at straight
};

#ifdef DEPARTURES
// Where a ray starts that leaves what was met. The shader that includes this file knows.
Start start_from(Met met, vec3 direction);
#endif
// ANCHOR_END: met

// ANCHOR: visibility
#ifdef SHADOWS
bool is_lit(vec3 origin, bool on_plane, Light light, vec3 to_light) {
#ifdef EFFECT_PLANE
    if (meet_plane(origin, to_light, light_end(light), on_plane) < FAR) {
        return false;
    }
#endif
    lit = false;
    traceRayEXT(
        tlas,
        // Any hit will do, and no shader needs to hear of it.
        RAY_FLAGS | gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT,
        RAY_MASK,
        0,                          // sbtRecordOffset
        1,                          // sbtRecordStride
        MISS_SHADOW,                // missIndex: shadow.rmiss
        origin,
        0.0,                        // tmin
        to_light,
        light_end(light),           // tmax
        1                           // payload location
    );
    return lit;
}

// Whether shadow rays go to a light.
bool casts_shadows(Light light, uint number) {
#ifndef EFFECT_POINT_SHADOWS
    if (light.kind == LIGHT_POINT) {
        return false;
    }
#endif
#ifndef EFFECT_DIRECTIONAL_SHADOWS
    if (light.kind == LIGHT_DIRECTIONAL) {
        return false;
    }
#endif
    return (push.world.shadows >> number & 1) != 0;
}
#endif

// What part of a light is seen, 0 to 1, by what was met.
float visibility(Met met, Light light, uint number) {
#ifdef SHADOWS
    if (!casts_shadows(light, number)) {
        return 1.0;
    }
#ifdef EFFECT_AREA_LIGHT
    bool soft = light.size > 0.0;
    uint count = soft ? push.world.light_samples : 1;
    uint bounce = 0;
    uint number_of_sample = 0;
#ifdef EFFECT_MIRROR
    bounce = payload.bounce;
#endif
#ifdef SAMPLE_NUMBERS
    number_of_sample = payload.number;
#endif
    vec2 start = random(gl_LaunchIDEXT.xy, number_of_sample, bounce, DIMENSION_LIGHT).xy;
#else
    const bool soft = false;
    const uint count = 1;
    const vec2 start = vec2(0.0);
    light.size = 0.0;
#endif
    uint seen = 0;
    for (uint i = 0; i < count; i++) {
        vec2 point = soft ? disk_point(i, count, start) : vec2(0.0);
        vec3 to_light = towards_light(light, met.position + met.lift, point);
        Start ray = start_from(met, to_light);
        // What is below the surface, the surface itself hides; that needs no ray.
        if (dot(met.up, to_light) > 0.0
            && is_lit(ray.origin + met.lift, met.on_plane, light, to_light)) {
            seen++;
        }
    }
    return float(seen) / float(count);
#else
    return 1.0;
#endif
}
// ANCHOR_END: visibility

// ANCHOR: kinds
// A light of the world. If all are of one kind, the compiler is told which.
Light light_of(uint number) {
    Light light = push.world.lights[number];
    light.kind = LIGHT_KINDS == 1 ? LIGHT_DIRECTIONAL : LIGHT_KINDS == 2 ? LIGHT_POINT : light.kind;
    return light;
}
// ANCHOR_END: kinds

#ifdef EFFECT_MIRROR
// What part of the light a polished surface reflects: `head_on` when looked at straight, and all of it
// at a grazing angle (Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994).
vec3 fresnel(vec3 head_on, float cosine) {
    float grazing = 1.0 - cosine;
    return head_on + (1.0 - head_on) * (grazing * grazing * grazing * grazing * grazing);
}

// Where a mirror sends a ray. Interpolated normals may send it into the triangle: it comes out again,
// mirrored at the triangle itself.
vec3 mirrored(vec3 direction, vec3 normal, vec3 up) {
    vec3 on = reflect(direction, normal);
    return normalize(on - 2.0 * min(dot(on, up), 0.0) * up);
}
#endif

// ANCHOR: shade
// Adds what is seen there, and sends the path on.
void shade(Met met) {
    vec3 view = -gl_WorldRayDirectionEXT;
    vec3 base = met.base_color;
#ifdef EFFECT_MIRROR
    vec3 mirror = met.reflection == vec3(0.0) || push.world.depth == 0
        ? vec3(0.0)
        : fresnel(met.reflection, max(dot(met.normal, view), 0.0));
    // What is reflected does not reach the colour below.
    base = met.base_color * (1.0 - mirror);
#endif
    vec3 color = met.emission + base * ambient(met.normal);
    for (uint i = 0; i < LIGHTS && i < push.world.light_count; i++) {
        Light light = light_of(i);
        float part = visibility(met, light, i);
        light.size = 0.0;
        vec3 to_light = normalize(towards_light(light, met.position, vec2(0.0)));
        color += part * arriving_light(light, met.position)
            * reflect_light(base, met.specular, met.shininess, met.normal, view, to_light);
    }
    gather(payload, color);
#ifdef EFFECT_MIRROR
    payload.throughput *= mirror;
    payload.bounce++;
    if (!goes_on(payload)) {
        return;
    }
    payload.direction = mirrored(-view, met.normal, met.flat_normal);
    payload.origin = start_from(met, payload.direction).origin;
#ifdef EFFECT_PLANE
    payload.on_plane = met.on_plane;
#endif
#ifdef SQUARES
    // A curved mirror turns what comes along the cone's sides apart, by twice the angle of its normals.
    float width = payload.width + payload.spread * met.t;
    float spread = payload.spread + 2.0 * met.curvature * width;
    payload.width = width;
    payload.spread = spread;
#endif
#endif
}
// ANCHOR_END: shade

// What a material mirrors, looked at straight.
vec3 mirrors(MaterialRecord material) {
    return material.illumination >= 3 ? material.specular : vec3(0.0);
}

#ifdef SQUARES
// How wide the cone of a pixel's rays is on a surface, along two of its axes, at distance t (chapter 12).
vec2 footprint(float t, vec3 direction, vec3 normal, vec3 u, vec3 v) {
    float from = 0.0;
#ifdef EFFECT_MIRROR
    from = payload.width;
#endif
    float width = from + payload.spread * t;
    vec3 along = direction - dot(direction, normal) * normal;
    float length_along = length(along);
    along = length_along > 0.0 ? along / length_along : u;
    vec3 across = cross(normal, along);
    float slant = max(abs(dot(direction, normal)) / length(direction), 1e-30);
    return width * vec2(length(vec2(dot(along, u) / slant, dot(across, u))),
                        length(vec2(dot(along, v) / slant, dot(across, v))));
}
#endif
