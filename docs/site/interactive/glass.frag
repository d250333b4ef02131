// A ray that divides at each surface of a body of glass. Pixel n holds ray n: 2n and 2n + 1 are what ray n becomes at
// the surface that it meets, reflected and refracted. Or, for the chart, what is reflected at each angle.
#include "common/sphere.glsl#sphere_stable"
#include "common/glass.glsl"

const float FAR = 1000.0;

uniform vec2 start;
uniform vec2 aim;
uniform float index;
uniform vec2 middle;
uniform float radius;       // 0: the body has faces
uniform vec3 faces[4];      // each face's outward normal, and how far it is from the middle; 0 for no face
uniform uint side;
uniform uint chart;

// Where ray n ends, what part of the light it has, and the cosine at the surface there, 2 if there is none. Or the parts
// reflected into the glass and out of it. All in bits.
out uvec4 answer;

// Where a ray meets the body, from outside or from within. A ray from within asks for the far side: so it does not meet
// the surface that it leaves.
bool meet(vec2 origin, vec2 d, bool inside, out float t, out vec2 normal) {
    vec2 f = origin - middle;
    vec2 ends;
    if (radius > 0.0) {
        bool met = sphere_stable(vec3(f, 0.0), vec3(d, 0.0), radius, ends);
        t = inside ? ends.y : ends.x;
        normal = normalize(f + t * d);
        return met && t > 0.0;
    }
    ends = vec2(-FAR, FAR);
    vec2 normals[2];
    for (int i = 0; i < 4; i++) {
        float slope = dot(d, faces[i].xy);
        float at = (faces[i].z - dot(f, faces[i].xy)) / slope;
        if (slope < 0.0 && at > ends.x) {
            ends.x = at;
            normals[0] = faces[i].xy;
        }
        if (slope > 0.0 && at < ends.y) {
            ends.y = at;
            normals[1] = faces[i].xy;
        }
    }
    t = inside ? ends.y : ends.x;
    normal = inside ? normals[1] : normals[0];
    return ends.x < ends.y && t > 0.0;
}

void main() {
    uint n = uint(gl_FragCoord.y) * side + uint(gl_FragCoord.x);
    if (chart == 1u) {
        float cosine = cos(1.5707963 * float(n) / float(side * side - 1u));
        answer = floatBitsToUint(vec4(unpolarised(fresnel_exact(cosine, 1.0, index).reflected),
            unpolarised(fresnel_exact(cosine, index, 1.0).reflected), 0.0, 0.0));
        return;
    }
    int level = 0;
    while ((n >> (level + 1)) > 0u) {
        level++;
    }
    vec2 origin = start, d = normalize(aim - start), normal;
    bool inside = false;
    float light = n == 0u ? 0.0 : 1.0;
    float t;
    for (; level > 0 && light > 0.0; level--) {
        if (!meet(origin, d, inside, t, normal)) {
            light = 0.0;
            break;
        }
        normal = inside ? -normal : normal;
        float from = inside ? index : 1.0;
        float to = inside ? 1.0 : index;
        Split split = fresnel_exact(min(-dot(d, normal), 1.0), from, to);
        origin += t * d;
        bool through = ((n >> (level - 1)) & 1u) == 1u;
        light *= unpolarised(through ? split.through : split.reflected);
        d = through ? refracted(vec3(d, 0.0), vec3(normal, 0.0), from, to).xy : reflect(d, normal);
        inside = inside != through;
    }
    bool met = meet(origin, d, inside, t, normal);
    answer = floatBitsToUint(vec4(origin + (met ? t : FAR) * d, light, met ? abs(dot(d, normal)) : 2.0));
}
