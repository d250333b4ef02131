// The time of a path: where its rays start, which intersection shaders can see (chapter 23).

#ifdef EFFECT_MOTION_BLUR
const uint DIMENSION_TIME = 8;

float tmin;

// Of all samples of a pixel in a frame, each has a part of the shutter's time to itself.
float time_of_sample(uvec2 id, uint sample_index) {
    float within = random(id, sample_index, 0, DIMENSION_TIME).x;
    float part = float(sample_index - push.world.first_sample) + within;
    return push.world.moving == 0 ? 0.0 : min(part / float(push.world.samples), 0.99999994);
}
#else
const float tmin = 0.0;
#endif
