// The declarations that the shaders of shapes share.

// Hit kinds of intersection shaders go from 0 to 127.
const uint KIND_SPHERE = 0;
const uint KIND_BOX = 1;
