// Where rays leave a shape that is placed as it is.

#ifdef DEPARTURES
const float ROUNDING = 5.9604645e-8;

// How far above the surface a ray must start.
float height;

// The bound of chapter 08 with the unit matrix: `own` is what the shape's test costs, in roundings; the
// device's own transform of the ray takes 30 of the point's coordinates.
void note_height(vec3 position, vec3 normal, vec3 own) {
    height = ROUNDING * dot(abs(normal), own + 30.0 * abs(position));
}

Start start_from(Met met, vec3 direction) {
    return Start(met.position + height * met.normal, 0.0);
}
#endif
