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
// ANCHOR_END: path

// The largest probability that a path survives a bounce, so that it ends even in a room that absorbs nothing.
const float LIKELIEST = 0.95;

// True if the next ray is worth tracing.
bool goes_on(inout Path path) {
    float contribution = largest(path.throughput);
    if (path.bounce > push.depth || contribution <= 0.0) {
        return false;
    }
    if (path.bounce > 1) {
        // A path that goes on also counts for those that end here.
        float survival = min(contribution, LIKELIEST);
        path.throughput /= survival;
        return numbers(path, DIMENSION_ROULETTE).x < survival;
    }
    return true;
}

// ANCHOR: part
// The part of the sky's light that a ray of the path counts. Shadow rays count the rest.
float part_by_bounce(Path path, float shadow_density) {
    if (SAMPLER == SAMPLER_BOUNCES || path.density == NO_OTHER) {
        return 1.0;
    }
    return SAMPLER == SAMPLER_BOTH ? path.density / (path.density + shadow_density) : 0.0;
}
// ANCHOR_END: part

// ANCHOR: ask
// A direction for a shadow ray from a hit, without light where something is in the way.
SkySample ask(inout Path path, Hit hit, vec3 from) {
    vec2 within = numbers(path, DIMENSION_POINT);
    SkySample found = sky_sample(push.sky, push.rotation, numbers(path, DIMENSION_LIGHT), within);
    bool may_be_lit = dot(found.direction, hit.face) > 0.0 && largest(found.radiance) > 0.0;
    if (may_be_lit) {
        path.rays++;
    }
    if (!may_be_lit || !is_lit(from, found.direction, 1e30)) {
        found.radiance = vec3(0.0);
    }
    return found;
}
// ANCHOR_END: ask

// The direction that `kept_above` mirrors to this one.
vec3 other_side(vec3 direction, vec3 face) {
    return direction - 2.0 * dot(direction, face) * face;
}

// 1 if shadow rays share the light with bounces, else 0.
const float BOUNCES = SAMPLER == SAMPLER_BOTH ? 1.0 : 0.0;

// As `balanced`, for a surface that scatters evenly with the probability `matte`, without its colour.
float balanced_matte(float cosine, float matte, float density) {
    float chance = max(cosine, 0.0) / PI;
    return chance / (density + (SAMPLER == SAMPLER_BOTH ? matte * chance : 0.0));
}

// A surface without microfacets: it scatters as in 11, and has no highlight, because nothing shines but the sky.
void scatter(inout Path path, inout Ray ray, Hit hit, MaterialRecord material, SkySample found,
        float choice, vec2 u) {
    vec3 color = hit.color;
    float to_eye = max(dot(hit.normal, -ray.direction), 0.0);
    bool polished = material.illumination >= ILLUMINATION_MIRROR;
    vec3 mirror = polished ? fresnel(material.specular, to_eye) : vec3(0.0);
    vec3 rest = color * (1.0 - (polished ? mirror : material.specular));
    // One of the two ways, chosen the more often the more light it brings.
    float mirrors = largest(mirror) / max(largest(mirror) + largest(rest), 1e-30);
    if (largest(found.radiance) > 0.0) {
        float to_light = max(dot(hit.normal, found.direction), 0.0);
        float across = dot(hit.normal, other_side(found.direction, hit.face));
        gather(path, found.radiance * scattered(material, color, to_eye, to_light)
            * (balanced_matte(to_light, 1.0 - mirrors, found.density)
                + balanced_matte(across, 1.0 - mirrors, found.density)));
    }
    if (choice < mirrors) {
        path.throughput *= mirror / mirrors;
        ray.direction = mirrored(ray.direction, hit.normal, hit.face);
        path.density = NO_OTHER;
    } else {
        vec3 on = cosine_direction(u, hit.normal);
        path.density = (1.0 - mirrors) * max(dot(on, hit.normal), 0.0) / PI;
        ray.direction = kept_above(on, hit.face);
        float to_next = max(dot(hit.normal, ray.direction), 0.0);
        path.throughput *= scattered(material, color, to_eye, to_next) / (1.0 - mirrors);
    }
}

// Lights and gathers the surface that a ray has met, and chooses the next ray.
void advance(inout Path path, inout Ray ray, RoughHit rough) {
    Hit hit = rough.hit;
    path.rays++;
    // ANCHOR: miss
    if (hit.t < 0.0) {
        gather(path, part_by_bounce(path, rough.density) * hit.color);
        path.throughput = vec3(0.0);
        path.bounce++;
        return;
    }
    // ANCHOR_END: miss
    MaterialRecord material = push.scene.materials.at[hit.material];
    gather(path, material.emission);
    // Shadow rays and the next ray start at one place, so that both see the same sky.
    vec3 from = hit.position + hit.offset * hit.face;
    // ANCHOR: light
    SkySample found = SkySample(hit.face, vec3(0.0), 1.0);
    if (SAMPLER != SAMPLER_BOUNCES && path.bounce < push.depth) {
        found = ask(path, hit, from);
    }
    // ANCHOR_END: light
    float choice = numbers(path, DIMENSION_CHOICE).x;
    vec2 u = numbers(path, DIMENSION_BOUNCE);
    // ANCHOR: rough
    if (rough.roughness >= 0.0) {
        mat3 frame = frame_of(hit.normal);
        // A row vector times a matrix is the transposed product: from the world into the frame.
        Microfacets surface = microfacets(push.rough, hit.color, rough.roughness, rough.metallic,
            -ray.direction * frame);
        if (largest(found.radiance) > 0.0) {
            // A bounce arrives at a direction by itself, or mirrored at the triangle: `kept_above`.
            gather(path, found.radiance * (balanced(surface, found.direction * frame, found.density, BOUNCES)
                + balanced(surface, other_side(found.direction, hit.face) * frame, found.density, BOUNCES)));
        }
        Bounce next = bounce(surface, choice, u);
        path.throughput *= next.weight;
        path.density = density_of(surface, choice, next);
        ray.direction = next.is_mirrored ? mirrored(ray.direction, hit.normal, hit.face)
            : kept_above(frame * next.direction, hit.face);
    } else {
        scatter(path, ray, hit, material, found, choice, u);
    }
    // ANCHOR_END: rough
    path.bounce++;
    ray.origin = from;
}
