// A ray against a box in 64 bits, for devices that have them.

const uint BOX_FLOAT64 = 4;

// box_division() once more, with doubles for floats; then the first hit with tmin < t <= tmax.
bool box_float64(
    vec3 o, vec3 d, float tmin, float tmax, vec3 low, vec3 high, out float t, out vec3 normal) {
    double nearest = -1e300LF;
    double farthest = 1e300LF;
    vec3 face_in = vec3(0.0);
    vec3 face_out = vec3(0.0);
    t = 0.0;
    normal = vec3(0.0);
    for (uint axis = 0; axis < 3; axis++) {
        if (d[axis] == 0.0) {
            if (o[axis] < low[axis] || o[axis] > high[axis]) {
                return false;
            }
            continue;
        }
        bool up = d[axis] > 0.0;
        precise double enter = (double(up ? low[axis] : high[axis]) - double(o[axis])) / double(d[axis]);
        precise double leave = (double(up ? high[axis] : low[axis]) - double(o[axis])) / double(d[axis]);
        if (enter > nearest) {
            nearest = enter;
            face_in = vec3(0.0);
            face_in[axis] = up ? -1.0 : 1.0;
        }
        if (leave < farthest) {
            farthest = leave;
            face_out = vec3(0.0);
            face_out[axis] = up ? 1.0 : -1.0;
        }
    }
    bool enters = nearest > double(tmin);
    double hit = enters ? nearest : farthest;
    if (nearest > farthest || !(hit > double(tmin) && hit <= double(tmax))) {
        return false;
    }
    t = float(hit);
    normal = enters ? face_in : face_out;
    return true;
}
