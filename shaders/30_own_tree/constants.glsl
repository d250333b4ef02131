// The specialization constants of a walk.
#ifndef FUSED
#define FUSED 0
#endif

layout(constant_id = 1) const uint BOXES = 3;
const uint BOXES_BARE = 0;
const uint BOXES_GUESS = 1;
const uint BOXES_IZE = 2;
const uint BOXES_BOUND = 3;
const uint BOXES_TWO_FLOAT = 4;

layout(constant_id = 2) const uint TRIANGLES = 1;
const uint TRIANGLES_MOELLER = 0;
const uint TRIANGLES_WATERTIGHT = 1;
const uint TRIANGLES_TWO_FLOAT = 2;

// True if nodes are read in 36 bytes.
layout(constant_id = 6) const bool QUANTISED = false;

// As many entries as the deepest way through both trees: no walk needs more.
layout(constant_id = 3) const uint STACK = 64;

// u = 2^-24. A reciprocal is off by up to 5u in Vulkan (2.5 ULP), a product by u, on both sides of a comparison.
const float SLACK = 1.0 + 16.0 / 16777216.0;
// The triangle's test sees each corner where it is not, by up to 6u of the largest number that it meets; a wall's
// distance is rounded twice more. Rounded up: a box that grows by so little is met no more often.
const float GROWTH = 32.0 / 16777216.0;
