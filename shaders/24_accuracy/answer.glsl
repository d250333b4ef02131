// The part that every query of the laboratory shares. After query.glsl.

const Answer NO_HIT = Answer(0, 0, 0.0, vec3(0.0), vec3(0.0), 0);

vec3 vector_at(Numbers numbers, uint first) {
    return vec3(numbers.at[first], numbers.at[first + 1], numbers.at[first + 2]);
}

// The root that counts, from inside the far one; whether it does.
bool first_root(vec2 t, Query query, out bool enters) {
    enters = t.x > query.tmin;
    float first = enters ? t.x : t.y;
    return first > query.tmin && first <= query.tmax;
}

// Of unit length. Where rounding has left no length, or one that overflows, any direction is as wrong as
// another; but it is a direction, and no NaN leaves.
vec3 unit(vec3 normal) {
    float square = dot(normal, normal);
    return square > 0.0 && square < 1e38 ? normalize(normal) : vec3(0.0, 0.0, 1.0);
}
