// Question number `wanted` of a march by one rung: where along the ray, and how high that is above the ground.
#include "common/heightfield.glsl#shape"

uniform HeightfieldShape land;
uniform vec3 o;
uniform vec3 d;
uniform float tmax;
uniform uint rung;
uniform uint side;

uint wanted;
uint asked = 0u;
vec2 place = vec2(0.0);

// A march asks through this, so that one of its questions is written down.
float heard(HeightfieldShape shape, vec3 o, vec3 d, float t) {
    float above = height_above(shape, o, d, t);
    if (asked == wanted) {
        place = vec2(t, above);
    }
    asked++;
    return above;
}

#define height_above heard
const uint MARCH_LIMIT = 10000u;
#include "common/heightfield.glsl#heightfield_relaxed"
#include "common/heightfield.glsl#lipschitz"
#include "common/heightfield.glsl#crossing"
#include "common/heightfield.glsl#heightfield_bisected"
#include "common/heightfield.glsl#heightfield_over_relaxed"

// t and height of the question, how many there are in all, and the t of the hit: 0 for a miss.
out uvec4 answer;

void main() {
    wanted = uint(gl_FragCoord.y) * side + uint(gl_FragCoord.x);
    HeightfieldHit hit;
    if (rung == 0u) {
        hit = heightfield_relaxed(land, o, d, 0.0, tmax);
    } else if (rung == 1u) {
        hit = heightfield_lipschitz(land, o, d, 0.0, tmax);
    } else if (rung == 2u) {
        hit = heightfield_over_relaxed(land, o, d, 0.0, tmax);
    } else {
        hit = heightfield_bisected(land, o, d, 0.0, tmax);
    }
    answer = uvec4(floatBitsToUint(place), asked, hit.met ? floatBitsToUint(hit.t) : 0u);
}
