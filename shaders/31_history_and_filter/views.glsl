// The quantities to show.
layout(constant_id = 2) const uint SHOW = 0;
const uint SHOW_PICTURE = 0;
const uint SHOW_LIGHT = 1;
const uint SHOW_LENGTH = 2;
const uint SHOW_DEVIATION = 3;
const uint SHOW_REFUSED = 4;
const uint SHOW_MOVEMENT = 5;
const uint SHOW_HIT = 6;

// True for the views that history.comp paints.
bool is_of_history() {
    return SHOW == SHOW_REFUSED || SHOW == SHOW_MOVEMENT || SHOW == SHOW_HIT;
}
