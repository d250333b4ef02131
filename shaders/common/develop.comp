#version 460
// Of no chapter: develops the picture that a window shows, as `Development` in Rust does for a PNG.
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x_id = 0, local_size_y_id = 1) in;

layout(set = 0, binding = 0, rgba32f) uniform readonly image2D picture;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D developed;

layout(push_constant, scalar) uniform Push {
    uvec2 size;
    float scale;    // two to the power of the exposure
    uint tone;
} push;

const uint TONE_REINHARD = 1;
const uint TONE_ACES = 2;

// The luminance that Reinhard's curve shows as white.
const float WHITE = 4.0;

vec3 shown(vec3 light) {
    if (push.tone == TONE_REINHARD) {
        float luminance = clamp(dot(light, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1e18);
        return light * ((1.0 + luminance / (WHITE * WHITE)) / (1.0 + luminance));
    }
    if (push.tone == TONE_ACES) {
        vec3 x = clamp(light, 0.0, 1e4);
        return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    }
    return light;
}

void main() {
    uvec2 id = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(id, push.size))) {
        return;
    }
    vec4 pixel = imageLoad(picture, ivec2(id));
    imageStore(developed, ivec2(id), vec4(shown(pixel.rgb * push.scale), pixel.a));
}
