#version 460
#extension GL_EXT_ray_tracing : require

// The ray has asked every surface on its way: what they had to say is in its payload.
void main() {
}
