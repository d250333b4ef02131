// Where mirrors and glass send a ray, and what it carries along.

// In an MTL file, the illumination model that is seen through (`illum 6`).
const uint ILLUMINATION_GLASS = 6;

// The index of refraction of all glass here. The eye is in the air.
const float GLASS_INDEX = 1.5;

// So many surfaces may turn a ray.
const uint DEPTH = 8;

struct Ray {
    vec3 origin;
    vec3 direction;
    float index;     // of refraction, where the ray is
    vec3 light;      // what part of the light at its end reaches the eye
};

// The picture, and what textures are read like, are of the surface at the path's end. All else is of its beginning.
bool looks_on() {
    return SHOW == SHOW_PICTURE || SHOW == SHOW_COLOR || SHOW == SHOW_LEVEL;
}

void mirror(inout Ray ray, inout Seen seen, vec3 normal, float curvature) {
    vec3 from = ray.direction;
#ifdef DIFFERENTIALS
    Axes at = met(seen.beam, seen.hit.t, from, normal);
    Axes was = seen.beam.direction;
    seen.beam = Beam(at, Axes(mirrored_step(at.a, was.a, from, normal, curvature),
                              mirrored_step(at.b, was.b, from, normal, curvature)));
#else
    seen.cone = after_mirror(seen.cone, seen.hit.t, curvature);
#endif
    ray.direction = mirrored(from, normal, seen.hit.face);
    ray.origin = seen.hit.position + seen.hit.offset * seen.hit.face;
}

void refract_into(inout Ray ray, inout Seen seen, vec3 normal, float curvature, float to) {
    vec3 from = ray.direction;
    vec3 on = refracted(from, normal, ray.index, to);
    float before = -dot(from, normal);
    float after = -dot(on, normal);
    float ratio = ray.index / to;
#ifdef DIFFERENTIALS
    Axes at = met(seen.beam, seen.hit.t, from, normal);
    Axes was = seen.beam.direction;
    seen.beam = Beam(at, Axes(refracted_step(at.a, was.a, from, normal, curvature, after, ratio),
                              refracted_step(at.b, was.b, from, normal, curvature, after, ratio)));
#else
    seen.cone = after_glass(seen.cone, seen.hit.t, curvature, before, after, ratio);
#endif
    // Interpolated normals may send it back to the side it came from: mirrored at the triangle, it goes through.
    ray.direction = normalize(on - 2.0 * max(dot(on, seen.hit.face), 0.0) * seen.hit.face);
    ray.origin = seen.hit.position - seen.hit.offset * seen.hit.face;
    ray.index = to;
}

// True if a mirror or glass sends the ray on; `ray` is then the next one. A surface with its own colour ends it.
bool sent_on(inout Ray ray, inout Seen seen) {
    if (seen.hit.t < 0.0 || !looks_on()) {
        return false;
    }
    MaterialRecord material = push.scene.materials.at[seen.hit.material];
    if (material.illumination < ILLUMINATION_MIRROR || material.base_color != vec3(0.0)) {
        return false;
    }
    // Near an outline the smooth normal may look away from the ray.
    vec3 normal = dot(ray.direction, seen.hit.normal) < 0.0 ? seen.hit.normal : seen.hit.face;
    float curvature = FOOTPRINT == FOOTPRINT_FLAT ? 0.0 : seen.curvature;
    float to = ray.index == 1.0 ? GLASS_INDEX : 1.0;
    ray.light *= material.specular;
    float sine = length(cross(ray.direction, normal));
    if (material.illumination == ILLUMINATION_GLASS && ray.index * sine < to) {
        refract_into(ray, seen, normal, curvature, to);
    } else {
        mirror(ray, seen, normal, curvature);     // by metal, or totally by glass
    }
    return true;
}
