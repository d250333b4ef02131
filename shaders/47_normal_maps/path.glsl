// A path of rays: what it has gathered, which ray is next, and whether that is worth tracing.

// ANCHOR: path
struct Path {
    uvec2 pixel;       // whose colour it makes
    vec3 color;        // what the eye sees so far
    vec3 throughput;   // the part of the next hit's light that reaches the eye
    uint bounce;       // the next reflection's number: 0 comes from the camera
    bool is_between;   // it goes back and forth between two facets of the last hit: no ray is traced
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

// A surface without microfacets: lit and left as in 11.
void scatter(inout Path path, inout Ray ray, Hit hit, MaterialRecord material, vec3 to_light, vec3 arriving,
        float choice, vec2 u) {
    vec3 color = hit.color;
    float to_eye = max(dot(hit.normal, -ray.direction), 0.0);
    hit.color = scattered(material, color, to_eye, max(dot(hit.normal, normalize(to_light)), 0.0));
    MaterialRecord lit = material;
    lit.specular *= kept_of_highlight(material.shininess);
    gather(path, material.emission + lit_by(arriving, to_light, hit, lit, -ray.direction));
    bool polished = material.illumination >= ILLUMINATION_MIRROR;
    vec3 mirror = polished ? fresnel(material.specular, to_eye) : vec3(0.0);
    vec3 rest = color * (1.0 - (polished ? mirror : material.specular));
    // One of the two ways, chosen the more often the more light it brings.
    float mirrors = largest(mirror) / max(largest(mirror) + largest(rest), 1e-30);
    if (choice < mirrors) {
        path.throughput *= mirror / mirrors;
        ray.direction = mirrored(ray.direction, hit.normal, hit.face);
    } else {
        vec3 on = cosine_direction(u, hit.normal);
        ray.direction = kept_above(on, hit.face);
        float to_next = max(dot(hit.normal, ray.direction), 0.0);
        path.throughput *= scattered(material, color, to_eye, to_next) / (1.0 - mirrors);
    }
}

// Ends a path that shows something else than light.
void show(inout Path path, vec3 normal, bool is_below, bool is_lost) {
    if (SHOW != SHOW_PICTURE) {
        path.color = SHOW == SHOW_NORMALS ? 0.5 + 0.5 * normal : vec3(SHOW == SHOW_BELOW ? is_below : is_lost);
        path.throughput = vec3(0.0);
    }
}

// Lights and gathers the surface that a ray has met, and chooses the next ray.
void advance(inout Path path, inout Ray ray, RoughHit rough) {
    Hit hit = rough.hit;
    if (hit.t < 0.0) {
        gather(path, SHOW == SHOW_PICTURE ? hit.color : vec3(0.0));
        path.throughput = vec3(0.0);
        path.bounce++;
        return;
    }
    MaterialRecord material = push.scene.materials.at[hit.material];
    // No ray of the path can hit the sun, so only this shadow ray finds it.
    RayOrigin start = shadow_start(hit);
    // Each path asks for the light at one point of the disk.
    DiskLight disk = DiskLight(push.light, push.light_size, 1);
    float visible = visible_part(disk, start, numbers(path, DIMENSION_LIGHT));
    vec3 to_light = towards_light(push.light, start.origin);
    vec3 arriving = visible * arriving_light(push.light, start.origin);
    float choice = numbers(path, DIMENSION_CHOICE).x;
    vec2 u = numbers(path, DIMENSION_BOUNCE);
    // ANCHOR: light
    if (rough.roughness >= 0.0) {
        mat3 frame = frame_of(hit.normal);
        // A row vector times a matrix is the transposed product: from the world into the frame.
        Relief relief = relief_of(rough.slope, -ray.direction * frame, path.is_between);
        vec3 light = normalize(to_light) * frame;
        Reflection next = reflection(relief, hit.color, rough.roughness, rough.metallic, light, path.is_between,
            choice, u, numbers(path, DIMENSION_WALL).x, numbers(path, DIMENSION_LEAVE));
        gather(path, (path.is_between ? vec3(0.0) : material.emission) + arriving * next.sun);
        vec3 direction = frame * next.direction;
        bool is_below = !next.is_black && next.leaves && dot(direction, hit.face) <= 0.0;
        bool is_dropped = is_below && (RULE == RULE_CUT || RULE == RULE_BENT);
        path.throughput *= is_dropped ? vec3(0.0) : next.weight;
        path.is_between = !next.leaves;
        ray.direction = RULE == RULE_NONE || path.is_between ? normalize(direction) : kept_above(direction, hit.face);
        bool is_lost = next.is_black || is_dropped || is_below && RULE == RULE_NONE;
        show(path, frame * relief.mapped, is_below, is_lost);
    } else {
        scatter(path, ray, hit, material, to_light, arriving, choice, u);
        show(path, hit.normal, false, false);
    }
    // ANCHOR_END: light
    path.bounce++;
    ray.origin = hit.position + hit.offset * hit.face;
}
