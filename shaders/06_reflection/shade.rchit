#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "push.glsl"
#include "common/offset.glsl"
#include "common/origin.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
layout(set = 1, binding = 0) uniform sampler2D textures[];

layout(location = 0) rayPayloadInEXT Path payload;
layout(location = 1) rayPayloadEXT bool lit;
hitAttributeEXT vec2 weights;

// From this number on, an MTL file's illumination model reflects (`illum 3`).
const uint ILLUMINATION_MIRROR = 3;

// ANCHOR: shadow
// Whether nothing lies between a point and the light, or a point of the light.
bool is_lit(Start ray, vec3 to_light) {
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
        ray.tmin / length(to_light),
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
float visibility(Departure from, vec3 lift, vec3 up) {
    if (push.shadow_rays == SHADOW_OFF) {
        return 1.0;
    }
    bool soft = push.light.size > 0.0;
    uint count = soft ? push.light_samples : 1;
    vec2 start = random(gl_LaunchIDEXT.xy, 0, payload.bounce, DIMENSION_LIGHT).xy;
    uint seen = 0;
    for (uint i = 0; i < count; i++) {
        vec2 point = soft ? disk_point(i, count, start) : vec2(0.0);
        vec3 to_light = towards_light(push.light, from.position + lift, point);
        Start ray = start_of_ray(push.origin, from, to_light);
        ray.origin += lift;
        // What is below the surface, the surface itself hides; that needs no ray.
        if (dot(up, to_light) > 0.0 && is_lit(ray, to_light)) {
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

// The nearest hit: normal, material and light give the colour.
void main() {
    // ANCHOR: fetch
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, weights);
    MaterialRecord material = push.scene.materials.at[instance.material];
    // ANCHOR_END: fetch
    // ANCHOR: normal
    // A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    vec3 view = -gl_WorldRayDirectionEXT;
    // Which side is seen, the triangle says: near an outline its smooth normal may look away.
    HitPoint hit = hit_point(instance, triangle, weights);
    normal = faceforward(normal, -hit.normal, normal);
    // ANCHOR_END: normal
    // Taken down before a shadow ray is traced: afterwards the software driver takes these for that
    // ray's own.
    vec4 identity = vec4(gl_InstanceCustomIndexEXT, triangle, gl_HitTEXT, gl_InstanceID);

    vec3 base = material.base_color;
    if (material.base_texture >= 0) {
        base *= textureLod(textures[nonuniformEXT(material.base_texture)], surface.uv, 0.0).rgb;
    }
    // ANCHOR: mirror
    vec3 mirror = material.illumination < ILLUMINATION_MIRROR
        ? vec3(0.0)
        : fresnel(material.specular, max(dot(normal, view), 0.0));
    // What is reflected does not reach the colour below.
    base *= 1.0 - mirror;
    // ANCHOR_END: mirror
    // ANCHOR: light
    Departure from = departure(hit, instance, triangle, weights);
    vec3 lift = vec3(0.0);
    vec3 up = hit.normal;
    if (push.smooth_terminator != 0) {
        lift = lift_to_smooth(hit, instance, triangle, weights);
        up = lift == vec3(0.0) ? up : normal;
    }
    float visible = visibility(from, lift, up);
    vec3 origin = hit.position + lift;
    vec3 light = normalize(towards_light(push.light, origin, vec2(0.0)));
    vec3 color = material.emission + base * ambient(normal);
    color += visible * arriving_light(push.light, origin)
        * reflect_light(base, material.specular, material.shininess, normal, view, light);
    // ANCHOR_END: light

    vec4 seen = vec4(color, 1.0);
    if (push.show == SHOW_NORMAL) {
        seen.rgb = 0.5 + 0.5 * normal;
    }
    if (push.show == SHOW_TRIANGLE) {
        seen.rgb = false_color(triangle);
    }
    if (push.show == SHOW_HIT) {
        seen = identity;
    }
    if (push.show == SHOW_DIRECTION) {
        seen = vec4(gl_WorldRayDirectionEXT, gl_HitTEXT);
    }
    if (push.show == SHOW_SHADOW) {
        seen.rgb = vec3(visible);
    }
    if (push.show == SHOW_SHADOW_ORIGIN) {
        seen = vec4(start_of_ray(push.origin, from, light).origin + lift, visible);
    }
    if (push.show == SHOW_RAY_ORIGIN) {
        seen = vec4(gl_WorldRayOriginEXT, gl_RayTminEXT);
    }

    // ANCHOR: bounce
    gather(payload, seen);
    payload.throughput *= mirror;
    payload.direction = mirrored(gl_WorldRayDirectionEXT, normal, hit.normal);
    Start ray = start_of_ray(push.origin, from, payload.direction);
    payload.origin = ray.origin;
    payload.tmin = ray.tmin;
    payload.bounce++;
    if (METHOD == METHOD_RECURSIVE && goes_on(payload)) {
        traceRayEXT(
            tlas,
            gl_RayFlagsNoneEXT,
            0xff,                   // cull mask: every instance
            0,                      // sbtRecordOffset: the first hit record of the instance
            1,                      // sbtRecordStride: one record a geometry
            0,                      // missIndex: sky.rmiss
            payload.origin,
            payload.tmin,
            payload.direction,
            1e30,                   // tmax
            0                       // payload location: the one that came in goes on
        );
    }
    // ANCHOR_END: bounce
}
