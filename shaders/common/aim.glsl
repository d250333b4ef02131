// Taught by 29_emitters.
//
// Where a shadow ray goes: to a point of an emitter that is chosen by chance.
#include "sphere_light.glsl"
#include "triangle_light.glsl"

Aim aim_at(Emitter emitter, vec3 from, vec2 u) {
    return emitter.radius > 0.0 ? aim_at_sphere(emitter, from, u) : aim_at_triangle(emitter, from, u);
}

// The same solid angle, for a direction that has met the emitter by chance, `t` away.
float angle_of(Emitter emitter, vec3 from, vec3 direction, float t) {
    return emitter.radius > 0.0 ? angle_of_sphere(emitter, from)
                                : angle_of_triangle(emitter, from, t * direction);
}
