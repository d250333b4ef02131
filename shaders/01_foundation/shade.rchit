#version 460
#extension GL_EXT_ray_tracing : require

// ANCHOR: payload
layout(location = 0) rayPayloadInEXT vec3 color;
// ANCHOR_END: payload
// ANCHOR: shade
hitAttributeEXT vec2 barycentrics;

// The nearest hit: the colours of the three corners, mixed by the weights of the point.
void main() {
    const vec3 first = vec3(0.06, 0.10, 0.80);
    const vec3 second = vec3(0.95, 0.03, 0.22);
    const vec3 third = vec3(1.00, 0.60, 0.06);
    color = (1.0 - barycentrics.x - barycentrics.y) * first + barycentrics.x * second + barycentrics.y * third;
}
// ANCHOR_END: shade
