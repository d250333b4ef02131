// The reflection of a surface with a mapped normal, under several rules for what the map makes impossible.
//
// Directions are in the frame of the surface's own normal, which is z.
#include "common/microfacet.glsl"

// The least height of a bent mirror's ray.
const float LIFT = 0.01;

// ANCHOR: relief
// A surface at a hit: the mapped normal, and a steep wall that completes it. Enough walls make a surface that is
// flat on the whole, as the triangle is (Schuessler, Heitz, Hanika and Dachsbacher 2017).
struct Relief {
    vec3 view;      // to where the path comes from: above the surface, or from the wall
    vec3 mapped;    // the normal to shade with
    vec3 wall;      // its normal, in the surface; zero without a map
    float sine;     // of the angle between the mapped normal and z: the wall's height
};

// The normal that mirrors the view above the surface, as close to the mapped one as it can be (Keller and others
// 2017).
vec3 bent(vec3 mapped, vec3 view) {
    vec3 mirrored = reflect(-view, mapped);
    mirrored.z = max(mirrored.z, LIFT);
    return mirrored.z > LIFT ? mapped : half_way(view, normalize(mirrored));
}

// `is_between` for a path that comes from the wall.
Relief relief_of(vec2 slope, vec3 view, bool is_between) {
    float inverse = inversesqrt(1.0 + dot(slope, slope));
    Relief relief;
    relief.view = is_between ? view : vec3(view.xy, max(abs(view.z), GRAZING));
    relief.mapped = vec3(slope * inverse, inverse);
    relief.sine = length(relief.mapped.xy);
    relief.wall = relief.sine > 0.0 ? vec3(-relief.mapped.xy / relief.sine, 0.0) : vec3(0.0);
    if (RULE == RULE_BENT) {
        relief.mapped = bent(relief.mapped, relief.view);
    }
    return relief;
}
// ANCHOR_END: relief

// ANCHOR: walls
// The areas that a direction sees of the mapped facet and of the wall, for a facet of area 1.
vec2 seen_areas(Relief relief, vec3 direction) {
    return vec2(max(dot(direction, relief.mapped), 0.0), max(dot(direction, relief.wall), 0.0) * relief.sine);
}

// The part of a direction's rays that meet the mapped facet first; the others meet the wall.
float part_of_mapped(Relief relief, vec3 direction) {
    vec2 areas = seen_areas(relief, direction);
    return areas.x / max(areas.x + areas.y, 1e-30);
}

// The part of the rays from either facet that leave the surface: Smith's G1 of the two.
float leaving(Relief relief, vec3 direction) {
    vec2 areas = seen_areas(relief, direction);
    float whole = direction.z * sqrt(max(1.0 - relief.sine * relief.sine, 0.0));
    return whole <= 0.0 ? 0.0 : min(whole / max(areas.x + areas.y, 1e-30), 1.0);
}

// Mirrored by the wall.
vec3 by_wall(Relief relief, vec3 direction) {
    return direction - 2.0 * dot(direction, relief.wall) * relief.wall;
}
// ANCHOR_END: walls

// The light of the sun, and a way for the path to go on.
struct Reflection {
    vec3 sun;          // the part of the sun's light that goes back: BRDF times cosine
    vec3 direction;
    vec3 weight;
    bool is_black;     // the eye is below the mapped normal's horizon
    bool leaves;       // false if the direction leads back to the mapped facet
};

// ANCHOR: sun
// The part of the sun's light that the mapped facet reflects, after it came directly or by way of the wall.
vec3 sun_on(Relief relief, Microfacets surface, mat3 frame, vec3 light) {
    if (RULE != RULE_TWO_FACETS) {
        return reflected_from(surface, light * frame);
    }
    vec3 sum = reflected_from(surface, light * frame);
    if (dot(light, relief.wall) > 0.0) {
        vec3 before = by_wall(relief, light);
        sum += reflected_from(surface, before * frame) * (1.0 - leaving(relief, before));
    }
    return sum * leaving(relief, light);
}
// ANCHOR_END: sun

// ANCHOR: reflection
// One reflection by the mapped facet. Before it, the wall may be in the way, and after it: `meets` and `leaves` are the
// random numbers that decide.
Reflection reflection(Relief relief, vec3 color, float roughness, float metallic, vec3 light, bool is_between,
        float choice, vec2 u, float meets, vec2 leaves) {
    Reflection next = Reflection(vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(0.0), false, true);
    if (RULE == RULE_TWO_FACETS && !is_between && meets >= part_of_mapped(relief, relief.view)) {
        relief.view = by_wall(relief, relief.view);
    }
    if (RULE != RULE_TWO_FACETS && RULE != RULE_FLIPPED && dot(relief.view, relief.mapped) <= 0.0) {
        next.is_black = true;
        return next;
    }
    mat3 frame = frame_of(relief.mapped);
    RoughAddresses rough = push.mapped.rough;
    Microfacets surface = microfacets(rough, color, roughness, metallic, relief.view * frame);
    next.sun = sun_on(relief, surface, frame, light);
    Bounce way = bounce(surface, choice, u);
    next.weight = way.weight;
    next.direction = frame * (way.is_mirrored ? vec3(-surface.view.xy, surface.view.z) : way.direction);
    if (RULE == RULE_TWO_FACETS && leaves.x >= leaving(relief, next.direction)) {
        next.direction = by_wall(relief, next.direction);
        next.leaves = leaves.y < leaving(relief, next.direction);
    }
    return next;
}
// ANCHOR_END: reflection
