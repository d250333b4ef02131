// The effect of a mirror and of a lens on a ray's cone, and on the rays of the next pixels.
//
// `curvature` is 1 / radius: positive where the surface bulges towards the ray, negative where it is hollow, and 0
// where it is flat. `before` and `after` are the cosines of the ray and of its refraction to the normal, positive.
// `ratio` is the index of refraction before the surface over that behind it.

// Across the cone the normals turn by curvature * width, and a mirror turns rays by twice that. A hollow one turns
// them towards each other: the width goes through zero, and grows again with the other sign.
Cone after_mirror(Cone cone, float t, float curvature) {
    float width = width_at(cone, t);
    return Cone(width, cone.spread + 2.0 * curvature * width);
}

// Along the slant a refracted cone becomes wider by after / before, and spreads less by the same; across it neither
// changes. One number has to stand for both: the root of their product, which keeps the area.
Cone after_glass(Cone cone, float t, float curvature, float before, float after, float ratio) {
    before = max(before, GRAZING);
    after = max(after, GRAZING);
    float width = width_at(cone, t);
    float wider = sqrt(after / before);
    float turned = (after - ratio * before) / before * curvature * width;
    return Cone(wider * width, (ratio * cone.spread - turned) / wider);
}

// The differences between the ray and those of the next pixel to the right (a) and below (b), in their
// origins and in their directions.
struct Beam {
    Axes origin;
    Axes direction;
};

float away_from_zero(float cosine) {
    return cosine < 0.0 ? min(cosine, -GRAZING) : max(cosine, GRAZING);
}

// Where a neighbour meets the plane of a hit, as a step from the hit.
vec3 met(vec3 origin, vec3 step, float t, vec3 direction, vec3 normal) {
    vec3 away = origin + t * step;
    return away - dot(away, normal) / away_from_zero(dot(direction, normal)) * direction;
}

Axes met(Beam beam, float t, vec3 direction, vec3 normal) {
    return Axes(met(beam.origin.a, beam.direction.a, t, direction, normal),
                met(beam.origin.b, beam.direction.b, t, direction, normal));
}

// ANCHOR: differentials
// The derivatives of mirrored and of refracted directions (Igehy, "Tracing Ray Differentials", 1999). A step along
// the surface turns the normal by curvature * step: exact on a sphere.
vec3 mirrored_step(vec3 at, vec3 step, vec3 direction, vec3 normal, float curvature) {
    vec3 turn = curvature * at;
    return step - 2.0 * (dot(direction, normal) * turn + (dot(step, normal) + dot(direction, turn)) * normal);
}

vec3 refracted_step(vec3 at, vec3 step, vec3 direction, vec3 normal, float curvature, float after, float ratio) {
    vec3 turn = curvature * at;
    float before = -dot(direction, normal);
    float change = dot(step, normal) + dot(direction, turn);      // of -before
    float slower = ratio - ratio * ratio * before / max(after, GRAZING);
    return ratio * step + (ratio * before - after) * turn - slower * change * normal;
}
// ANCHOR_END: differentials

// Two steps that lean towards each other bound a narrow ellipse, and neither is its axis. Turned by an angle into
// each other they are perpendicular, and bound the same one. Twice the angle has the tangent lean / longer; of the
// two angles, this is the one of at most 45 degrees, and `into` is its tangent.
Axes principal(Axes axes) {
    float lean = 2.0 * dot(axes.a, axes.b);
    float longer = dot(axes.a, axes.a) - dot(axes.b, axes.b);
    float size = sqrt(longer * longer + lean * lean);
    float sum = longer < 0.0 ? longer - size : longer + size;
    // Of a circle, or so small that a device may take a square for 0 in one place and not in another.
    if (abs(sum) < 1e-30) {
        return axes;
    }
    float into = lean / sum;
    float cosine = inversesqrt(1.0 + into * into);
    return Axes(cosine * (axes.a + into * axes.b), cosine * (axes.b - into * axes.a));
}
