// Emitters: shadow rays sample their light, and paths hit them at random (chapter 29).
#include "common/aim.glsl"

// The purposes of random numbers: to choose an emitter, and a point of it.
const uint DIMENSION_EMITTER = 6;
const uint DIMENSION_POINT = 7;

// The density of `kept_above(cosine_direction(u, normal), up)`: of a direction, and of the one that is
// mirrored to it.
float likelihood(vec3 direction, vec3 normal, vec3 up) {
    float above = dot(direction, up);
    vec3 other = direction - 2.0 * above * up;
    float both = max(dot(direction, normal), 0.0) + max(dot(other, normal), 0.0);
    return above > 0.0 ? both / 3.14159265 : 0.0;
}

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

// The light of an emitter that a surface scatters, sampled by a shadow ray. `matte` is the probability that
// the path also scatters, and may hit the emitter at random.
vec3 asked(Path path, Hit hit, float matte) {
    if (push.world.emitters.column_count == 0 || hit.color == vec3(0.0)) {
        return vec3(0.0);
    }
    Emitter emitter = push.world.emitters.emitters.at[chosen(numbers(path, DIMENSION_EMITTER))];
    // The next ray starts at the same place, or the two chances would not be those of one direction.
    vec3 from = hit.position + hit.offset * hit.face;
    Aim aim = aim_at(emitter, from, numbers(path, DIMENSION_POINT));
    float chance = likelihood(aim.direction, hit.normal, hit.face) * aim.angle;
    float weight = chance / (emitter.probability + matte * chance);
    if (chance <= 0.0 || !is_lit(from, aim.to, 1.0, hit.material == MATERIAL_PLANE)) {
        return vec3(0.0);
    }
    vec3 radiance = push.scene.materials.at[emitter.material].emission;
#ifdef EFFECT_GLASS
    radiance *= left_on_way(path.media, length(aim.to));
#endif
    return weight * hit.color * radiance;
}
