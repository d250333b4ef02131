#version 460
#extension GL_EXT_ray_tracing : require

// ANCHOR: miss
layout(location = 0) rayPayloadInEXT vec3 color;

// The ray hit nothing: a night sky, lighter towards the bottom of the picture.
void main() {
    float height = clamp(0.5 + 1.3 * gl_WorldRayDirectionEXT.y, 0.0, 1.0);
    color = mix(vec3(0.085, 0.120, 0.200), vec3(0.005, 0.008, 0.022), height);
}
// ANCHOR_END: miss
