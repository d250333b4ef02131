// Which boxes the device offers to a ray: how many, and then their places, in the order of its calls.
const uint MOST = 7;

layout(buffer_reference, scalar) buffer Offered { uint at[]; };

layout(push_constant, scalar) uniform Push {
    Offered offered;
} push;
