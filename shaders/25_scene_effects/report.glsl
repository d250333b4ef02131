// The report of the hit shaders of shapes: spheres, boxes, solids, strands and tori, which have no transform.

#ifdef EFFECT_PATTERNS
#include "finish.glsl"
#endif

// `own` is what the shape's test costs, in roundings; the device's own transform of the ray takes 30 of
// the point's coordinates (chapter 08, with the unit matrix).
Hit report(vec3 point, vec3 outward, vec3 own, float curvature, uint material) {
    Hit hit;
    hit.position = point;
    hit.t = gl_HitTEXT;
    hit.normal = faceforward(outward, gl_WorldRayDirectionEXT, outward);
    hit.material = material;
    hit.color = push.scene.materials.at[material].base_color;
#ifdef EFFECT_PATTERNS
    if (finish_of(material).pattern != PATTERN_PLAIN) {
        hit.color = point;
    }
#endif
#ifdef DEPARTURES
    const float ROUNDING = 5.9604645e-8;
    hit.offset = ROUNDING * dot(abs(hit.normal), own + 30.0 * abs(point));
    hit.face = hit.normal;
#endif
#ifdef TERMINATOR
    hit.terminator_offset = vec3(0.0);
#endif
#ifdef EFFECT_GLASS
    hit.entering = dot(outward, gl_WorldRayDirectionEXT) < 0.0;
#endif
#ifdef CHANCES
    hit.emitter = NO_EMITTER;
#endif
#ifdef CURVES
    hit.curvature = curvature;
#endif
#ifdef EFFECT_HISTORY
    // The bend of a curved shape within a pixel is unknown here, so it is the largest.
    hit.surface = (SURFACE_SHAPE | gl_PrimitiveID & 0x3fffu) << 16 | (curvature == 0.0 ? 0u : 255u);
#endif
#ifdef TOLD_CONES
    hit.cone = vec2(0.0);
#endif
    return hit;
}
