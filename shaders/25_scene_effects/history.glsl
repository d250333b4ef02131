// Light of earlier frames, as in 31, but in the shader that traces: it only reads what the last frame has left.
#include "common/past_light.glsl"

layout(set = 0, binding = 2, scalar) buffer Past {
    CameraBasis camera;      // of the last frame
    PixelAddresses pixels;
    Backs back;              // of each placed mesh
    uint back_count;
    uint memory;             // the longest history, in frames; 1 where it begins, and 0 in a scene that does not move
    uint stands;             // whether everything is where it was in the last frame
    uint divide;             // whether light is divided by the colour of its surface
    float rounding;          // a bound on the error of a distance between two points of the scene
} past;

uint past_index(uvec2 id) {
    return id.y * past.pixels.size.x + id.x;
}

// True if light stays on the surface: a mirror's moves with what it shows, and its own glow has no noise.
bool keeps_light(Hit hit, MaterialRecord material, vec3 reflection) {
#ifdef EFFECT_GLASS
    if (is_glass(hit)) {
        return false;
    }
#endif
#ifdef EFFECT_ROUGH_METAL
    if (microfacet_of(hit).roughness >= 0.0) {
        return false;
    }
#endif
    return reflection == vec3(0.0) && material.emission == vec3(0.0);
}

// Notes the surface that a pixel sees, and about what part of its light it sends on.
void see(uvec2 id, Hit hit) {
    if (past.memory == 0) {
        return;
    }
    Seen surface = Seen(vec3(0.0), 0u, packed_rest(NOTHING, 1, 0.0));
    vec3 color = vec3(1.0);
    if (hit.t >= 0.0) {
        vec3 reflection;
        MaterialRecord material = material_of(hit, reflection);
        if (keeps_light(hit, material, reflection)) {
            surface = Seen(hit.position, packed(hit.face), hit.surface | 1u << 8);
            color = past.divide != 0 ? mix(hit.color, vec3(1.0), material.specular) : vec3(1.0);
        }
    }
    past.pixels.surfaces.at[past_index(id)] = surface;
    past.pixels.colors.at[past_index(id)] = packed_color(color);
}

// The light that the last frame knew of what a pixel sees.
Found found_for(uvec2 id, uint index) {
    Found found = nothing_found();
    if (past.stands != 0) {
        // Whatever the pixel's rays meet, they met it in the last frame.
        take(found, past.pixels, index, past.pixels.last_surfaces.at[index], 1.0);
        return found;
    }
    Seen here = past.pixels.surfaces.at[index];
    vec2 now;
    if (past.memory < 2 || instance_of(here) == NOTHING
        || !project(push.camera, here.position, past.pixels.size, now)) {
        return found;
    }
    Seen before = here;
    vec3 normal = unpacked(here.normal);
    if (instance_of(here) < past.back_count) {
        Back back = past.back.at[instance_of(here)];
        mat3 turn = mat3(back.x, back.y, back.z);
        before.position = turn * here.position + back.origin;
        normal = turn * normal;
    }
    vec2 then;
    if (project(past.camera, before.position, past.pixels.size, then)) {
        // As far as the surface has moved in the picture: of several rays, none goes through the pixel's middle.
        vec2 point = vec2(id) + 0.5 + (then - now);
        found = find(past.pixels, past.camera, before, normal, point, past.rounding, Tests(true, true, true));
    }
    return found;
}

// The mean of a pixel's colour and of what earlier frames knew of its light.
vec3 with_past(uvec2 id, vec3 color) {
    if (past.memory == 0) {
        return color;
    }
    uint index = past_index(id);
    vec3 divisor = unpacked_color(past.pixels.colors.at[index]);
    vec3 light = color / divisor;
    Found found = found_for(id, index);
    if (found.weight > 0.0) {
        float count = min(round(found.frames) + 1.0, float(past.memory));
        light = found.estimate.light + (light - found.estimate.light) / count;
        color = light * divisor;
        uint rest = past.pixels.surfaces.at[index].rest;
        past.pixels.surfaces.at[index].rest = rest & 0xffff00ffu | uint(count) << 8;
    }
    past.pixels.estimates.at[index] = Estimate(light, 0.0);
    return color;
}
