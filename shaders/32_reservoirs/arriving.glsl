// The light that a sample brings to a receiver, if nothing is in its way.
#include "common/surface.glsl"
#include "common/likelihood.glsl"
#include "common/aim.glsl"
#include "common/shadow.glsl"

struct Light {
    vec3 color;     // for all random numbers that choose a point of the emitter
    vec3 to;        // where its shadow ray ends
};

// ANCHOR: arriving
// A sample is an emitter and two numbers, and each receiver makes a point of these by itself. So all receivers
// integrate over the same unit square, and no density has to be converted when a sample moves to another pixel.
Light arriving(Receiver receiver, uint index, uint at) {
    Emitter emitter = push.emitters.emitters.at[index];
    vec2 u = (vec2(at & 0xffffu, at >> 16u) + 0.5) / 65536.0;
    Aim aim = aim_at(emitter, receiver.from, u);
    float density = likelihood(aim.direction, unpacked(receiver.normal), unpacked(receiver.face));
    vec3 radiance = push.scene.materials.at[emitter.material].emission;
    return Light(radiance * density * max(aim.angle, 0.0), aim.to);
}

// The target: a sample is chosen by the brightness of its light, without the shadow.
float brightness(Light light) {
    float value = dot(light.color, vec3(0.2126, 0.7152, 0.0722));
    // Weights divide by it, and their quotients must be finite.
    return value > 1e-12 ? min(value, 1e12) : 0.0;
}
// ANCHOR_END: arriving

// The target of a sample at a receiver. With visibility it is 0 in shadow; `is_seen` says that this was tested before.
float target(Receiver receiver, Reservoir reservoir, bool is_seen) {
    Light light = arriving(receiver, reservoir.emitter, reservoir.at);
    float value = brightness(light);
    bool is_hidden = VISIBILITY && !is_seen && value > 0.0 && !is_lit(receiver.from, light.to, 1.0);
    return is_hidden ? 0.0 : value;
}
