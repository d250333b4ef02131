#version 460
#extension GL_EXT_ray_tracing : require

layout(location = 1) rayPayloadInEXT bool lit;

// The ray met nothing on its way to the light.
void main() {
    lit = true;
}
