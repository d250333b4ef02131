#version 460
// Taught by 05_shadow_miss.
#extension GL_EXT_ray_tracing : require

// ANCHOR: miss
layout(location = 1) rayPayloadInEXT bool lit;

// The ray met nothing on its way to the light.
void main() {
    lit = true;
}
// ANCHOR_END: miss
