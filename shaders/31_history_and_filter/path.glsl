// A path of rays: what it has gathered, which ray is next, and whether that is worth tracing.

// ANCHOR: path
struct Path {
    uvec2 pixel;       // whose colour it makes
    vec3 color;        // what the eye sees so far
    vec3 throughput;   // the part of the next hit's light that reaches the eye
    uint bounce;       // the next ray's number: 0 comes from the camera
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
    path.color += path.throughput * seen;
}
// ANCHOR_END: path

// ANCHOR: roulette
// The largest probability that a path survives a bounce, so that it ends even in a room that absorbs nothing.
const float LIKELIEST = 0.95;

// True if the next ray is worth tracing.
bool goes_on(inout Path path) {
    float contribution = largest(path.throughput);
    if (path.bounce > push.depth || contribution <= 0.0) {
        return false;
    }
    if (ROULETTE && path.bounce > 1) {
        // A path that goes on also counts for those that end here.
        float survival = min(contribution, LIKELIEST);
        path.throughput /= survival;
        return numbers(path, DIMENSION_ROULETTE).x < survival;
    }
    return true;
}
// ANCHOR_END: roulette

// Lights and gathers the surface that a ray has met, and chooses the next ray.
void advance(inout Path path, inout Ray ray, Hit hit) {
    if (hit.t < 0.0) {
        gather(path, hit.color);
        path.throughput = vec3(0.0);
        path.bounce++;
        return;
    }
    MaterialRecord material = push.scene.materials.at[hit.material];
    vec3 color = hit.color;
    float to_eye = max(dot(hit.normal, -ray.direction), 0.0);
    // ANCHOR: light
    // No ray of the path can hit the sun, so only this shadow ray finds it.
    RayOrigin start = shadow_start(hit);
    float visible = visible_part(push.light, start, numbers(path, DIMENSION_LIGHT));
    vec3 to_light = towards_light(push.light.light, start.origin);
    hit.color = scattered(material, color, to_eye, max(dot(hit.normal, normalize(to_light)), 0.0));
    MaterialRecord lit = material;
    lit.specular *= kept_of_highlight(material.shininess);
    vec3 arriving = visible * arriving_light(push.light.light, start.origin);
    // The first surface's own emission is not reflected light; compose.comp adds it.
    vec3 shines = path.bounce == 0 ? vec3(0.0) : material.emission;
    gather(path, shines + lit_by(arriving, to_light, hit, lit, -ray.direction));
    // ANCHOR_END: light
    // ANCHOR: next
    bool polished = material.illumination >= ILLUMINATION_MIRROR;
    vec3 mirror = polished ? fresnel(material.specular, to_eye) : vec3(0.0);
    vec3 rest = color * (1.0 - (polished ? mirror : material.specular));
    // One of the two ways, chosen the more often the more light it brings.
    float mirrors = largest(mirror) / max(largest(mirror) + largest(rest), 1e-30);
    if (numbers(path, DIMENSION_CHOICE).x < mirrors) {
        path.throughput *= mirror / mirrors;
        ray.direction = mirrored(ray.direction, hit.normal, hit.face);
    } else {
        vec3 on = cosine_direction(numbers(path, DIMENSION_BOUNCE), hit.normal);
        ray.direction = kept_above(on, hit.face);
        float to_next = max(dot(hit.normal, ray.direction), 0.0);
        path.throughput *= scattered(material, color, to_eye, to_next) / (1.0 - mirrors);
    }
    path.bounce++;
    ray.origin = hit.position + hit.offset * hit.face;
    // ANCHOR_END: next
}
