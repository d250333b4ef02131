// The light that arrives at a point, computed by a callable shader or by a function.

struct Arrival {
    vec3 from;         // the point
    vec3 to_light;     // the way there
    float end;         // where a shadow ray along it ends
    vec3 strength;     // what arrives if nothing is in the way
};

void arrive(inout Arrival arrival, Light light) {
    arrival.to_light = towards_light(light, arrival.from);
    arrival.end = light_end(light);
    arrival.strength = arriving_light(light, arrival.from);
}
