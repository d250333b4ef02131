// Taught by 05_shadow_miss.
//
// The view that a pipeline is made for: code for any other is not even compiled.
layout(constant_id = 0) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_NORMAL = 1;
const uint SHOW_TRIANGLE = 2;
const uint SHOW_HIT = 3;
const uint SHOW_DIRECTION = 4;
const uint SHOW_SHADOW = 5;
const uint SHOW_ORIGIN = 6;
