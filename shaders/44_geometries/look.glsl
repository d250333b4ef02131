// Shared by the looks: the data of the record, the surface, and a polished finish.
#include "push.glsl"

layout(location = 0) rayPayloadInEXT vec4 payload;
hitAttributeEXT vec2 barycentrics;

// ANCHOR: look
// The data after the handle in this shader's record.
layout(shaderRecordEXT, scalar) buffer Look {
    vec3 tint;
    float scale;         // of the texture: larger is finer
    float roughness;
    uint record;         // the record's number, also the seed of the piece's pattern
} look;
// ANCHOR_END: look

// The triangle that was hit. A place's meshes are neighbours in the scene's array: the custom index is that of
// its first, and the geometry's index counts on from there. `gl_PrimitiveID` begins at 0 in every geometry.
Surface surface_at_hit() {
    uint number = gl_InstanceCustomIndexEXT + gl_GeometryIndexEXT;
    InstanceRecord instance = push.scene.instances.at[number];
    return surface_at(instance, instance.original.at[gl_PrimitiveID], barycentrics);
}

// The point that was hit, in the mesh's own space: there the texture stays in place when a piece moves.
vec3 object_position() {
    return gl_ObjectRayOriginEXT + gl_HitTEXT * gl_ObjectRayDirectionEXT;
}

// The width of a pixel on the surface, in the mesh's own space: the geometric mean of its two sides. One
// side alone would not do, because it grows without end towards the silhouette.
float pixel_width(vec3 normal) {
    float angle = 2.0 * length(push.camera.up) / float(push.rows);
    float across = gl_HitTEXT * length(gl_ObjectRayDirectionEXT) * angle;
    return across * inversesqrt(max(dot(normal, -gl_WorldRayDirectionEXT), 0.05));
}

// A normal turns with the inverse transpose; a row vector times a matrix is the transposed product.
// The flat triangle decides which side the ray sees: near an outline the smooth normal may look away.
vec3 world_normal(Surface surface) {
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    vec3 face = vec3(surface.face * gl_WorldToObjectEXT);
    return faceforward(normal, -faceforward(face, gl_WorldRayDirectionEXT, face), normal);
}

// A base colour under a clear coat, which mirrors the sky the more, the flatter one looks at it
// (Schlick 1994) and the smoother it is.
vec3 polished(vec3 base, vec3 normal) {
    vec3 view = -gl_WorldRayDirectionEXT;
    float alpha = look.roughness * look.roughness;
    // The exponent whose highlight is as wide as a microfacet surface of this roughness.
    float shininess = 2.0 / (alpha * alpha) - 2.0;
    vec3 color = base * ambient(normal) + push.light.radiance
        * reflect_light(base, vec3(0.04), shininess, normal, view, push.light.direction);
    float x = 1.0 - clamp(dot(normal, view), 0.0, 1.0);
    float fresnel = 0.04 + 0.96 * x * x * x * x * x;
    return mix(color, sky(reflect(-view, normal)), fresnel * (1.0 - look.roughness));
}

// The result of a look: its colour, or the number of its group or record.
vec4 answer(uint group, vec3 color) {
    if (push.show == SHOW_GROUP) {
        return vec4(GROUP_COLOR[group], group);
    }
    if (push.show == SHOW_RECORD) {
        return vec4(false_color(look.record + 1), look.record);
    }
    return vec4(color, 1.0);
}
