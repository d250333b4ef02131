#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "common/hit_point.glsl"
#include "report.glsl"
#include "common/pattern.glsl"
#include "finish.glsl"

// The nearest hit on marble: the record has chosen this shader, and nothing is left to choose.
void main() {
    report();
    Finish finish = push.finishes.at[hit.material];
    mix_colors(hit, finish, marble(finish.scale * hit.object, int(push.far)));
}
