// Fog: how much of it a ray goes through, and what that leaves of the light.
//
// For shaders that have included solid.glsl.

// The length of the way from 0 to `end` that lies in a solid and within its clip.
float way_within(SolidRecord solid, vec3 o, vec3 d, float end) {
    Interval clip = in_clip(solid, o, d);
    float t = max(clip.enter, 0.0);
    end = min(clip.leave, end);
    follow(solid, o, d, t, end);
    float way = 0.0;
    while (t < end) {
        float next = min(change_after(t), end);
        way += holds(solid, members_after(t)) ? next - t : 0.0;
        t = next;
    }
    return way;
}

// The length of a ray outside all solids, up to its end.
//
// Closed solids need no test: a ray that arrives at one ends there, and a camera within one has another
// pipeline. But a clip has no surface, so rays go in and out.
float way_outside(vec3 o, vec3 d, float end) {
    if (FOG != FOG_OUTSIDE) {
        return end;
    }
    float within = 0.0;
    for (uint i = 0; i < push.solids.count; i++) {
        SolidRecord solid = push.solids.at.at[i];
        if (solid.clip != NO_CLIP) {
            vec3 own = in_space_of(solid, vec4(o, 1.0));
            within += way_within(solid, own, in_space_of(solid, vec4(d, 0.0)), end);
        }
    }
    return max(end - within, 0.0);
}

// The part of the light that is left after a way through fog.
float clear_after(float way) {
    return FOG == FOG_NONE ? 1.0 : exp(-way / push.fog.distance);
}
