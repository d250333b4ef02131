// A ray against a box: low.xyz, high.xyz.
#include "answer.glsl"
#include "common/box.glsl"
#include "box_padded.glsl"
#include "box_two_float.glsl"

bool box_by(uint rung, vec3 o, vec3 d, vec3 low, vec3 high, out vec2 t, out vec3 faces[2]) {
    switch (rung) {
        case BOX_RECIPROCAL: return box_reciprocal(o, d, low, high, t, faces);
        case BOX_PADDED: return box_padded(o, d, low, high, t, faces);
        default: return box_division(o, d, low, high, t, faces);
    }
}

Answer ask_box(uint rung, Query query, Numbers numbers) {
    vec3 low = vector_at(numbers, query.first);
    vec3 high = vector_at(numbers, query.first + 3);
    Answer answer = NO_HIT;
#ifdef EXACT
    if (rung == BOX_TWO_FLOAT) {
        bool met = box_two_float(query.origin, query.direction, query.tmin, query.tmax, low, high,
            answer.t, answer.normal);
        answer.hit = met ? 1 : 0;
        return answer;
    }
#endif
    vec2 t;
    vec3 faces[2];
    bool enters;
    if (box_by(rung, query.origin, query.direction, low, high, t, faces)
        && first_root(t, query, enters)) {
        answer.hit = 1;
        answer.t = enters ? t.x : t.y;
        answer.normal = enters ? faces[0] : faces[1];
    }
    return answer;
}
