#version 460
#extension GL_EXT_ray_tracing : require

layout(location = 1) rayPayloadInEXT bool lit;

// Something hides the light. Shadow rays skip this shader, because `lit` starts as false.
void main() {
    lit = false;
}
