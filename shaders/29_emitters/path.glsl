// A path of rays: what it has gathered, which ray is next, and whether that is worth tracing.

// ANCHOR: path
struct Path {
    uvec2 pixel;       // whose colour it makes
    vec3 color;        // what the eye sees so far
    vec3 throughput;   // the part of the next hit's light that reaches the eye
    uint bounce;       // the next ray's number: 0 comes from the camera
    float density;     // of the next ray's direction; NO_OTHER if no shadow ray could have gone there
    uint rays;         // how many rays, of all kinds, were traced
};

// The camera and a mirror leave no choice.
const float NO_OTHER = -1.0;
// ANCHOR_END: path

struct Ray {
    vec3 origin;
    vec3 direction;
};

vec2 numbers(Path path, uint dimension) {
    return numbers(path.pixel, push.sample_index, path.bounce, dimension, push.seed);
}

// Adds the light of a hit, or of the sky.
void gather(inout Path path, vec3 seen) {
    vec3 light = path.throughput * seen;
    if (path.bounce > 0 && push.most > 0.0) {
        light *= push.most / max(largest(light), push.most);
    }
    path.color += light;
}

// True if the next ray is worth tracing. Roulette never ends a path that has lost no light.
bool goes_on(inout Path path) {
    float contribution = largest(path.throughput);
    if (path.bounce > push.depth || contribution <= 0.0) {
        return false;
    }
    if (path.bounce > 1 && contribution < 1.0) {
        // A path that goes on also counts for those that end here.
        path.throughput /= contribution;
        return numbers(path, DIMENSION_ROULETTE).x < contribution;
    }
    return true;
}

// The part of an emitter's light that a ray of the path counts if it hits it. Shadow rays count the rest.
float part_by_chance(Path path, Ray ray, Hit hit) {
    if (ESTIMATOR == ESTIMATOR_BSDF || path.density == NO_OTHER) {
        return 1.0;
    }
    if (ESTIMATOR == ESTIMATOR_LIGHT) {
        return 0.0;
    }
    uint index = push.emitters.first.at[hit.instance] + hit.triangle;
    Emitter emitter = push.emitters.emitters.at[index];
    float chance = path.density * angle_of(emitter, ray.origin, ray.direction, hit.t);
    return chance / max(chance + probability_of(index), 1e-30);
}

// Adds the light that shadow rays find. `matte` is the probability that the path scatters at this surface
// instead of being mirrored.
void ask(inout Path path, Hit hit, MaterialRecord material, vec3 from, float to_eye, float matte) {
    for (uint i = 0; i < choices(); i++) {
        Choice chosen = choice(i, numbers(path, DIMENSION_EMITTER));
        Emitter emitter = push.emitters.emitters.at[chosen.emitter];
        Aim aim = aim_at(emitter, from, numbers(path, DIMENSION_POINT + i));
        float density = likelihood(aim.direction, hit.normal, hit.face);
        if (aim.angle <= 0.0 || density <= 0.0) {
            continue;
        }
        path.rays++;
        if (!is_lit(from, aim.to, 1.0)) {
            continue;
        }
        float chance = ESTIMATOR == ESTIMATOR_MIS ? matte * density * aim.angle : 0.0;
        vec3 radiance = push.scene.materials.at[emitter.material].emission;
        float to_light = max(dot(aim.direction, hit.normal), 0.0);
        gather(path, scattered(material, hit.color, to_eye, to_light) * radiance * density * aim.angle
            / (chosen.probability + chance));
    }
}

// Lights a hit, adds its light to the path, and sets up the next ray.
void advance(inout Path path, inout Ray ray, Hit hit) {
    if (hit.t < 0.0) {
        gather(path, hit.color);
        path.throughput = vec3(0.0);
        path.bounce++;
        return;
    }
    MaterialRecord material = push.scene.materials.at[hit.material];
    // ANCHOR: light
    if (largest(material.emission) > 0.0) {
        gather(path, part_by_chance(path, ray, hit) * material.emission);
    }
    // ANCHOR_END: light
    float to_eye = max(dot(hit.normal, -ray.direction), 0.0);
    bool polished = material.illumination >= ILLUMINATION_MIRROR;
    vec3 mirror = polished ? fresnel(material.specular, to_eye) : vec3(0.0);
    vec3 rest = hit.color * (1.0 - (polished ? mirror : material.specular));
    // One of the two ways, chosen the more often the more light it brings.
    float mirrors = largest(mirror) / max(largest(mirror) + largest(rest), 1e-30);
    // Shadow rays and the next ray start at one place, so that the chances of both are about the same
    // direction. There is no lift to the smooth surface: a path could end up within another surface.
    vec3 from = hit.position + hit.offset * hit.face;
    if (ESTIMATOR != ESTIMATOR_BSDF && path.bounce < push.depth && largest(rest) > 0.0) {
        ask(path, hit, material, from, to_eye, 1.0 - mirrors);
    }
    if (numbers(path, DIMENSION_CHOICE).x < mirrors) {
        path.throughput *= mirror / mirrors;
        ray.direction = mirrored(ray.direction, hit.normal, hit.face);
        path.density = NO_OTHER;
    } else {
        vec3 on = cosine_direction(numbers(path, DIMENSION_BOUNCE), hit.normal);
        ray.direction = kept_above(on, hit.face);
        float to_next = max(dot(hit.normal, ray.direction), 0.0);
        path.throughput *= scattered(material, hit.color, to_eye, to_next) / (1.0 - mirrors);
        path.density = (1.0 - mirrors) * likelihood(ray.direction, hit.normal, hit.face);
    }
    path.bounce++;
    ray.origin = from;
}
