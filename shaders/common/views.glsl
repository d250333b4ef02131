// Taught by 05_shadow_miss.
//
// The views that show a hit instead of the picture, for a hit, its ray, and the origin of its shadow ray. A
// chapter tests for views of its own first.
#include "show.glsl"
#include "hit.glsl"
#include "false_color.glsl"

vec4 view_of(Hit hit, vec3 direction, vec3 origin, float visible) {
    bool missed = hit.t < 0.0;
    switch (SHOW) {
        case SHOW_NORMAL: return vec4(missed ? hit.color : 0.5 + 0.5 * hit.normal, 1.0);
        case SHOW_TRIANGLE: return vec4(missed ? hit.color : false_color(hit.triangle), 1.0);
        case SHOW_HIT: return missed ? vec4(-1.0) : vec4(hit.instance, hit.triangle, hit.t, hit.material);
        case SHOW_DIRECTION: return vec4(direction, hit.t);
        case SHOW_SHADOW: return vec4(missed ? hit.color : vec3(visible), 1.0);
        default: return missed ? vec4(-1.0) : vec4(origin, visible);
    }
}
