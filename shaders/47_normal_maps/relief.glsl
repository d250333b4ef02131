// The reflection of a surface with a mapped normal, under several rules for what the map makes impossible.
//
// Directions are in the frame of the surface's own normal, which is z.
#include "common/path_numbers.glsl"
#include "45_rough_metal/microfacet.glsl"

// The purposes of numbers that earlier chapters do not have; those of each further reflection follow.
const uint DIMENSION_LEAVE = 5;
const uint DIMENSION_WALL = 6;
const uint DIMENSIONS = 8;

// Reflections in one hollow. The light of a path that needs more leaves all the same.
const uint REFLECTIONS = 16;

// The least height of a bent mirror's ray.
const float LIFT = 0.01;

// ANCHOR: relief
// A surface at a hit: the mapped normal, and a steep wall that completes it. Enough walls make a surface that is
// flat on the whole, as the triangle is (Schuessler, Heitz, Hanika and Dachsbacher 2017).
struct Relief {
    vec3 view;      // to the eye, above the surface
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

Relief relief_of(vec2 slope, vec3 view) {
    float inverse = inversesqrt(1.0 + dot(slope, slope));
    Relief relief;
    relief.view = vec3(view.xy, max(abs(view.z), GRAZING));
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
    vec3 sun;          // the light of the sun that goes to the eye
    vec3 direction;
    vec3 weight;
    bool is_black;     // the eye is below the mapped normal's horizon
    uint count;        // how many reflections there were
};

// ANCHOR: sun
// The part of the sun's light that the mapped facet reflects to `surface.view` directly, or by way of the wall.
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
// The reflection of a hit. A path between two facets is followed until it leaves; the sun lights each of its points.
// `arriving` is the sun's light, from the direction `light`; `most` bounds what a further reflection adds, unless it is 0.
Reflection reflection(Relief relief, vec3 color, float roughness, float metallic, vec3 light, vec3 arriving,
        float most, uvec2 pixel, uint bounce_number) {
    Reflection all = Reflection(vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(1.0), false, 0);
    mat3 frame = frame_of(relief.mapped);
    vec3 back = relief.view;    // where the path has come from
    if (RULE == RULE_TWO_FACETS) {
        if (numbers(pixel, push.sample_index, bounce_number, DIMENSION_WALL, push.seed).x
                >= part_of_mapped(relief, back)) {
            back = by_wall(relief, back);
        }
    } else if (RULE != RULE_FLIPPED && dot(back, relief.mapped) <= 0.0) {
        all.weight = vec3(0.0);
        all.is_black = true;
        return all;
    }
    do {
        uint first = all.count * DIMENSIONS;
        float choice = numbers(pixel, push.sample_index, bounce_number, first + DIMENSION_CHOICE, push.seed).x;
        vec2 u = numbers(pixel, push.sample_index, bounce_number, first + DIMENSION_BOUNCE, push.seed);
        Microfacets surface = microfacets(color, roughness, metallic, back * frame);
        vec3 sun = all.weight * arriving * sun_on(relief, surface, frame, light);
        all.sun += all.count > 0 && most > 0.0 ? sun * most / max(largest(sun), most) : sun;
        Bounce next = bounce(surface, choice, u);
        all.weight *= next.weight;
        all.direction = frame * (next.is_mirrored ? vec3(-surface.view.xy, surface.view.z) : next.direction);
        all.count++;
        if (RULE != RULE_TWO_FACETS || largest(all.weight) <= 0.0) {
            return all;
        }
        vec2 leave = numbers(pixel, push.sample_index, bounce_number, first + DIMENSION_LEAVE, push.seed);
        if (leave.x < leaving(relief, all.direction)) {
            return all;
        }
        all.direction = by_wall(relief, all.direction);
        if (leave.y < leaving(relief, all.direction)) {
            return all;
        }
        back = -all.direction;
    } while (all.count < REFLECTIONS);
    all.direction.z = abs(all.direction.z);
    return all;
}
// ANCHOR_END: reflection
