#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/extensions.glsl"
#include "push.glsl"
#include "hit.glsl"
#include "report.glsl"
#include "common/pattern.glsl"
#include "finish.glsl"

// The nearest hit on marble: the record has chosen this shader, and nothing is left to choose.
void main() {
    report();
    Finish finish = push.finishes.at[seen.hit.material];
    mix_colors(seen, finish, marble(finish.scale * seen.object, int(push.far)));
}
