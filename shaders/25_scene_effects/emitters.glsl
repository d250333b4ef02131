// Emitters: shadow rays sample their light, and paths hit them at random (chapter 29).
#include "common/aim.glsl"

// The purposes of random numbers: to choose an emitter, and a point of it.
const uint DIMENSION_EMITTER = 6;
const uint DIMENSION_POINT = 7;

#ifdef CHANCES
// A ray has met what shines. What part of that light is counted here: the rest is that of shadow rays, by the
// balance heuristic. What no shadow ray could have found is counted as a whole.
float part_by_chance(Path path, Ray ray, Hit hit) {
    if (path.density == NO_OTHER || hit.emitter == NO_EMITTER) {
        return 1.0;
    }
    Emitter emitter = push.world.emitters.emitters.at[hit.emitter];
    float chance = path.density * angle_of(emitter, ray.origin, ray.direction, hit.t);
    return chance / max(chance + emitter.probability, 1e-30);
}
#endif

// The emitter chosen, in proportion to its power. Both numbers are multiples of 2^-24, and there are 2^k
// columns, so nothing here is rounded.
uint chosen(vec2 u) {
    uint column = uint(u.x * float(push.world.emitters.column_count));
    Column found = push.world.emitters.columns.at[column];
    return u.y < found.own ? column : found.other;
}

// The shadow ray to an emitter, with what the surface sends on of its light.
Sought to_emitter(Path path, Hit hit, Scatterer by, vec3 from) {
    Sought sought = nothing_sought();
    if (push.world.emitters.column_count == 0 || hit.color == vec3(0.0)) {
        return sought;
    }
    Emitter emitter = push.world.emitters.emitters.at[chosen(numbers(path, DIMENSION_EMITTER))];
    Aim aim = aim_at(emitter, from, numbers(path, DIMENSION_POINT));
    vec3 part = sent_on(by, hit, aim.direction, aim.angle, emitter.probability);
    if (part == vec3(0.0)) {
        return sought;
    }
    vec3 radiance = push.scene.materials.at[emitter.material].emission;
#ifdef EFFECT_GLASS
    radiance *= left_on_way(path.media, length(aim.to));
#endif
    return Sought(aim.to, 1.0, part * radiance);
}
