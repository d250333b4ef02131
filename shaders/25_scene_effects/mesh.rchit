#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "common/hit_point.glsl"

#ifdef TERMINATOR
#include "common/terminator.glsl"
#endif
#ifdef FINISHES
#include "finish.glsl"
#endif
#ifdef EFFECT_WIREFRAME
#include "lines.glsl"
#endif
#ifdef EFFECT_HISTORY
#include "common/bend.glsl"
#include "common/seen.glsl"
#endif

#if defined(EFFECT_TEXTURES) || defined(EFFECT_NORMAL_MAPS)
layout(set = 1, binding = 0) uniform sampler2D textures[];
#endif
#ifdef EFFECT_FILTERED_TEXTURES
#include "common/footprint.glsl"
#include "common/lookup.glsl"
#endif
#ifdef EFFECT_NORMAL_MAPS
#include "common/slope.glsl"
#endif

layout(location = 0) rayPayloadInEXT Hit hit;
hitAttributeEXT vec2 barycentrics;

#ifdef CURVES
// By how much the normal turns in a unit of length: from the triangle's corners, along its edges.
float curvature(InstanceRecord instance, uint triangle) {
    uvec3 corner = instance.triangles.at[triangle];
    float most = 0.0;
    for (int i = 0; i < 3; i++) {
        Vertex a = instance.vertices.at[corner[i]];
        Vertex b = instance.vertices.at[corner[(i + 1) % 3]];
        vec3 edge = gl_ObjectToWorldEXT * vec4(b.position - a.position, 0.0);
        most = max(most, length(b.normal - a.normal) / length(edge));
    }
    return most;
}
#endif

#ifdef EFFECT_FILTERED_TEXTURES
// The row of a texture for the ray's cone (chapter 19).
Row row_on(InstanceRecord instance, uint triangle, vec3 face, int index) {
    if (push.world.filtered == 0) {
        return Row(vec2(0.0), 1, 0.0);
    }
    uvec3 corner = instance.triangles.at[triangle];
    Vertex a = instance.vertices.at[corner.x];
    Vertex b = instance.vertices.at[corner.y];
    Vertex c = instance.vertices.at[corner.z];
    vec3 e1 = mat3(gl_ObjectToWorldEXT) * (b.position - a.position);
    vec3 e2 = mat3(gl_ObjectToWorldEXT) * (c.position - a.position);
    Mapping mapping = mapping_of(e1, e2, b.uv - a.uv, c.uv - a.uv);
    // Many curved mirrors widen a cone beyond what floats can say.
    float width = min(hit.cone.x + hit.cone.y * gl_HitTEXT, 1e15);
    Axes axes = ellipse(width, gl_WorldRayDirectionEXT, face);
    vec2 size = vec2(textureSize(textures[nonuniformEXT(index)], 0));
    return row_of(on_texture(mapping, axes.a), on_texture(mapping, axes.b), size);
}
#endif

#ifdef EFFECT_NORMAL_MAPS
// The normal that a material's map has in place of `normal`: by the rule *flipped* of chapter 47. One that looks away
// from where the ray came from is mirrored to that side, and rays that it sends below the triangle come out again by
// `mirrored` and `kept_above`.
vec3 mapped_normal(InstanceRecord instance, uint triangle, Surface surface, vec3 normal) {
    if (instance.material >= push.world.map_count) {
        return normal;
    }
    NormalMapRecord map = push.world.normal_maps.at[instance.material];
    if (map.number < 0) {
        return normal;
    }
    vec3 slope = slope_at(instance, triangle, surface, map, normal);
    if (slope == vec3(0.0)) {
        return normal;
    }
    vec3 mapped = normalize(normal + slope);
    return dot(mapped, gl_WorldRayDirectionEXT) > 0.0 ? reflect(mapped, gl_WorldRayDirectionEXT) : mapped;
}
#endif

#ifdef ROUGH_TEXTURES
// Green is roughness and blue is metalness, as in glTF; textures without a curve for the eye.
uint rough_texels(uint material, vec2 uv) {
    vec2 texels = vec2(1.0);
    if (material < push.world.rough_count) {
        MicrofacetRecord record = push.rough.microfacets.at[material];
        if (record.roughness_texture >= 0) {
            texels.x = textureLod(textures[nonuniformEXT(record.roughness_texture)], uv, 0.0).g;
        }
        if (record.metallic_texture >= 0) {
            texels.y = textureLod(textures[nonuniformEXT(record.metallic_texture)], uv, 0.0).b;
        }
    }
    // As packUnorm2x16, whose error Vulkan does not bound.
    uvec2 parts = uvec2(round(clamp(texels, 0.0, 1.0) * 65535.0));
    return parts.x | parts.y << 16;
}
#endif

#ifdef FINISHES
// The triangle's corners in the mesh's own space.
vec3[3] corners_of(InstanceRecord instance, uint triangle) {
    uvec3 corner = instance.triangles.at[triangle];
    return vec3[](
        instance.vertices.at[corner.x].position,
        instance.vertices.at[corner.y].position,
        instance.vertices.at[corner.z].position);
}

vec3 point_between(vec3 corners[3], vec2 w) {
    return corners[0] + w.x * (corners[1] - corners[0]) + w.y * (corners[2] - corners[0]);
}
#endif

// The nearest hit is a triangle.
void main() {
    InstanceRecord instance = push.scene.instances.at[gl_InstanceCustomIndexEXT];
    uint triangle = instance.original.at[gl_PrimitiveID];
    Surface surface = surface_at(instance, triangle, barycentrics);
    MaterialRecord material = push.scene.materials.at[instance.material];
    HitPoint at = hit_point(instance, triangle, barycentrics);
    hit.position = at.position;
    hit.t = gl_HitTEXT;
    // The triangle's own normal decides which side is seen: near an outline the smooth one may look away.
    vec3 normal = normalize(vec3(surface.normal * gl_WorldToObjectEXT));
    hit.normal = faceforward(normal, -at.face, normal);
#ifdef EFFECT_NORMAL_MAPS
    hit.normal = mapped_normal(instance, triangle, surface, hit.normal);
#endif
    hit.material = instance.material;
    hit.color = material.base_color;
#ifdef EFFECT_TEXTURES
    if (material.base_texture >= 0) {
        int index = material.base_texture;
#ifdef EFFECT_FILTERED_TEXTURES
        hit.color *= texture_along(index, surface.uv, row_on(instance, triangle, at.face, index));
#else
        hit.color *= textureLod(textures[nonuniformEXT(index)], surface.uv, 0.0).rgb;
#endif
    }
#endif
#ifdef DEPARTURES
    hit.offset = at.offset;
    hit.face = at.face;
#endif
#ifdef TERMINATOR
    hit.terminator_offset = terminator_offset(at.face, instance, triangle, barycentrics, gl_ObjectToWorldEXT);
#endif
#ifdef ROUGH_TEXTURES
    hit.rough = rough_texels(instance.material, surface.uv);
#endif
#ifdef EFFECT_GLASS
    // A normal without faceforward looks out of the body.
    hit.entering = dot(vec3(surface.face * gl_WorldToObjectEXT), at.face) > 0.0;
#endif
#ifdef CHANCES
    hit.emitter = NO_EMITTER;
    if (push.world.emitters.column_count > 0) {
        uint first = push.world.emitters.first.at[gl_InstanceCustomIndexEXT];
        hit.emitter = first == NO_EMITTER ? NO_EMITTER : first + triangle;
    }
#endif
#ifdef CURVES
    hit.curvature = curvature(instance, triangle);
#endif
#ifdef EFFECT_HISTORY
    hit.surface = packed_rest(gl_InstanceCustomIndexEXT & 0x7fffu, 0, bend(instance, triangle));
#endif
#ifdef FINISHES
    Finish finish = finish_of(instance.material);
#endif
#ifdef EFFECT_PATTERNS
    if (finish.pattern != PATTERN_PLAIN) {
        hit.color = point_between(corners_of(instance, triangle), barycentrics);
    }
#endif
#ifdef EFFECT_WIREFRAME
    float covered = 0.0;
    if (finish.lines > 0.0) {
        vec3 corners[3] = corners_of(instance, triangle);
        for (int k = 0; k < 3; k++) {
            corners[k] = gl_ObjectToWorldEXT * vec4(corners[k], 1.0);
        }
        covered = line_coverage(
            corners, gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT, hit.cone, finish.lines);
    }
    hit.cone = vec2(covered, 0.0);
#endif
}
