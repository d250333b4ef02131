// A ray against the unit sphere under a matrix: the matrix, its inverse, and the inverse of its linear
// part in two floats an entry; all by rows.
#include "answer.glsl"
#include "common/instance.glsl"
#include "instance_two_float.glsl"
#include "common/sphere.glsl"

const uint INSTANCE_MATRIX = 0;
const uint INSTANCE_INVERSE = 1;

// Nine numbers by rows as a matrix, `stride` from one row to the next.
mat3 matrix_at(Numbers numbers, uint first, uint stride) {
    return transpose(mat3(
        vector_at(numbers, first),
        vector_at(numbers, first + stride),
        vector_at(numbers, first + 2 * stride)));
}

vec3 last_column_at(Numbers numbers, uint first) {
    return vec3(numbers.at[first + 3], numbers.at[first + 7], numbers.at[first + 11]);
}

TwoFloat3 row_at(Numbers numbers, uint first) {
    return TwoFloat3(
        vec2(numbers.at[first], numbers.at[first + 9]),
        vec2(numbers.at[first + 1], numbers.at[first + 10]),
        vec2(numbers.at[first + 2], numbers.at[first + 11]));
}

Answer ask_instance(uint rung, Query query, Numbers numbers) {
    uint whole_inverse = query.first + 12;
    uint linear_inverse = query.first + 24;
    vec3 translation = last_column_at(numbers, query.first);
    mat3 inverse = matrix_at(numbers, linear_inverse, 3);
    Answer answer = NO_HIT;
#ifdef EXACT
    if (rung == INSTANCE_TWO_FLOAT) {
        TwoFloatRows rows = TwoFloatRows(
            row_at(numbers, linear_inverse),
            row_at(numbers, linear_inverse + 3),
            row_at(numbers, linear_inverse + 6));
        bool met = instance_two_float(query.origin, query.direction, query.tmin, query.tmax,
            matrix_at(numbers, query.first, 4), translation, rows, answer.t, answer.normal);
        answer.hit = met ? 1 : 0;
        return answer;
    }
#endif
    vec3 origin;
    if (rung == INSTANCE_MATRIX) {
        mat3 part = matrix_at(numbers, whole_inverse, 4);
        mat4x3 whole = mat4x3(
            part[0], part[1], part[2], last_column_at(numbers, whole_inverse));
        origin = object_origin_matrix(whole, query.origin);
    } else {
        origin = object_origin_inverse(inverse, translation, query.origin);
    }
    precise vec3 direction = inverse * query.direction;
    vec2 t;
    bool enters;
    if (sphere_stable(origin, direction, 1.0, t) && first_root(t, query, enters)) {
        answer.hit = 1;
        answer.t = enters ? t.x : t.y;
        // By the inverse transpose.
        answer.normal = normalize((origin + answer.t * direction) * inverse);
    }
    return answer;
}
