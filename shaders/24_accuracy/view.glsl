// A picture by one rung, and beside it how far that rung is off from the top one.
#include "common/band.glsl"
#include "common/camera.glsl"
#include "common/shade.glsl"
#include "query.glsl"
#include "ask.glsl"
#if PRIMITIVE == PRIMITIVE_SECONDARY_ORIGIN
#include "ask_sphere.glsl"
#endif

layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D picture;

layout(push_constant, scalar) uniform View {
    CameraBasis camera;
    Numbers numbers;
    uint count;   // of the numbers
    vec3 sun;     // towards it
    uint show;
} view;

// The rung that is held to be the truth: its error is below one unit in the last place.
layout(constant_id = 2) const uint TOP = 0;

const uint SHOW_SPLIT = 0;
const uint SHOW_PICTURE = 1;
const uint SHOW_ERROR = 2;

// Black to one unit in the last place; then blue, green and yellow to red, a colour for every factor of
// about 30. Magenta for a hit that is none, cyan for a miss that is none.
const vec3 HEAT[6] = vec3[](
    vec3(0.02), vec3(0.05, 0.15, 0.5), vec3(0.03, 0.38, 0.06), vec3(0.75, 0.7, 0.1), vec3(0.9, 0.3, 0.02), vec3(0.6, 0.0, 0.0)
);

vec3 heat(Answer answer, Answer truth) {
    if (answer.hit != truth.hit) {
        return answer.hit != 0 ? vec3(0.9, 0.0, 0.8) : vec3(0.0, 0.8, 0.9);
    }
    if (truth.hit == 0) {
        return vec3(0.2);
    }
    // Gaps between floats: bits of positive floats are in order.
    float gaps = abs(float(floatBitsToInt(answer.t) - floatBitsToInt(truth.t)));
    float at = clamp(log2(max(gaps, 1.0)) / 5.0, 0.0, 4.999);
    return mix(HEAT[int(at)], HEAT[int(at) + 1], fract(at));
}

// A surface with squares as large as one, so that a wrong t shows.
vec3 shade(Query query, Answer answer) {
    if (answer.hit == 0) {
        return sky(query.direction);
    }
    vec3 point = query.origin + answer.t * query.direction;
    bvec3 odd = notEqual(ivec3(floor(4.0 * point + 0.001)) & 1, ivec3(0));
    bool dark = PRIMITIVE == PRIMITIVE_PLANE || PRIMITIVE == PRIMITIVE_HEIGHTFIELD ? odd.x != odd.z : (odd.x != odd.y) != odd.z;
    vec3 base = dark ? vec3(0.16, 0.06, 0.03) : vec3(0.75, 0.6, 0.4);
    vec3 light = 3.0 * reflect_light(base, vec3(0.04), 60.0, answer.normal, -query.direction, view.sun);
    return light + base * ambient(answer.normal);
}

void main() {
    uvec2 id = pixel_id();
    vec2 point = vec2(id) + 0.5;
    uvec2 size = imageSize(picture);
    bool right = view.show == SHOW_ERROR;
    if (view.show == SHOW_SPLIT) {
        size.x = (size.x + 1) / 2;
        right = id.x >= size.x;
        point.x -= right ? float(size.x) : 0.0;
    }
    Query query = Query(view.camera.origin, 0.0, ray_direction(view.camera, point, size), 1e30, 0, view.count, 0);
    Answer answer = ask(query, view.numbers);
#if PRIMITIVE == PRIMITIVE_SECONDARY_ORIGIN
    // A ray that leaves the sphere must not hit it again.
    Answer seen = ask_sphere(SPHERE_STABLE, Query(query.origin, 0.0, query.direction, 1e30, 1, view.count, 0), view.numbers);
    bool lit = dot(seen.normal, view.sun) > 0.0;
    bool acne = seen.hit != 0 && lit && answer.hit != 0;
    seen.normal = lit && !acne ? seen.normal : -view.sun;
    vec3 found = acne ? vec3(0.9, 0.0, 0.8) : seen.hit != 0 ? vec3(0.02) : vec3(0.2);
    vec3 color = right ? found : shade(query, seen);
#else
    vec3 color = right ? heat(answer, ASK(TOP, query, view.numbers)) : shade(query, answer);
#endif
    imageStore(picture, ivec2(id), vec4(color, 1.0));
}
