// Fog: how much of it a ray goes through, and what that leaves of the light.
//
// For closest hit and miss shaders, after push.glsl.
#include "solid.glsl"

// ANCHOR: outside
// How far the ray goes outside of all solids, up to where it ends.
//
// Closed solids need no look: a ray that comes to one ends there, and a camera within one has another
// pipeline. But a clip has no surface, and rays go in and out. So they do of a plane that is passed from
// inside.
float way_outside(float end) {
    if (FOG != FOG_OUTSIDE) {
        return end;
    }
    vec3 o = gl_WorldRayOriginEXT;
    vec3 d = gl_WorldRayDirectionEXT;
    float within = 0.0;
    for (uint i = 0; i < push.world.solid_count; i++) {
        SolidRecord solid = push.world.solids.solids.at[i];
        if (solid.clip != NO_CLIP) {
            vec3 own = in_space_of(solid, vec4(o, 1.0));
            within += way_within(solid, own, in_space_of(solid, vec4(d, 0.0)), end);
        }
    }
    if (push.world.inside != INSIDE_NONE) {
        vec2 below = clamp(in_half_space(push.world.plane, 1.0, o, d), 0.0, end);
        within += max(below.y - below.x, 0.0);
    }
    return max(end - within, 0.0);
}
// ANCHOR_END: outside

// What part of the light is left after a way through fog.
float clear_after(float way) {
    return FOG == FOG_NONE ? 1.0 : exp(-way / push.world.fog.distance);
}
