// Direct: the raygen shader calls the intersection itself, and no acceleration structure is asked.
#include "query.glsl"
#include "ask.glsl"

void main() {
    uint asked = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
    if (asked >= push.asked) {
        return;
    }
    uint i = asked % push.count;
#if PRIMITIVE == PRIMITIVE_ACCUMULATION
    // A long sum takes several dispatches, each short enough for any driver's patience.
    Answer answer = sum_on(
        RUNG, push.queries.at[i], push.numbers, push.from, push.until, push.answers.at[i]);
#else
    Answer answer = ask(push.queries.at[i], push.numbers);
#endif
    for (uint k = 1; k < push.repeat; k++) {
        Answer more = ask(push.queries.at[(i + k) % push.count], push.numbers);
        // The sum is not used, but it keeps the compiler from leaving a call out.
        answer.t += more.t;
        answer.hit += more.hit;
    }
    answer.offered = 1;
    // A repeated ray only keeps the device busy. No answer is `never`, but a compiler cannot know that.
    if (asked < push.count || answer.t == push.never) {
        push.answers.at[i] = answer;
    }
}
