// A ray against a voxel in 64 bits, for devices that have them: voxel_two_float() with doubles.

const uint VOXEL_FLOAT64 = 4;

double voxel_at(double c[4], double t) {
    precise double value = ((c[3] * t + c[2]) * t + c[1]) * t + c[0];
    return value;
}

int voxel_sign(double a) {
    return a > 0.0LF ? 1 : a < 0.0LF ? -1 : 0;
}

double voxel_root(double c[4], double low, double high, int sign_at_low) {
    double t = 0.5LF * (low + high);
    for (int i = 0; i < 100; i++) {
        double value = voxel_at(c, t);
        if (value == 0.0LF) {
            break;
        }
        if (voxel_sign(value) == sign_at_low) {
            low = t;
        } else {
            high = t;
        }
        precise double slope = (3.0LF * c[3] * t + 2.0LF * c[2]) * t + c[1];
        precise double next = slope != 0.0LF ? t - value / slope : low;
        next = next > low && next < high ? next : 0.5LF * (low + high);
        if (next == t) {
            break;
        }
        t = next;
    }
    return t;
}

double voxel_between(double a, double b, double from_low, double to_high) {
    precise double mean = a * to_high + b * from_low;
    return mean;
}

int voxel_sign_at_face(Voxel v, double from_low[3], double to_high[3], dvec3 d, int k, bool is_high) {
    int i = (k + 1) % 3;
    int j = (k + 2) % 3;
    double way = is_high ? to_high[k] : -from_low[k];
    precise double a0 = to_high[i] * d[k] - way * d[i];
    precise double a1 = from_low[i] * d[k] + way * d[i];
    precise double b0 = to_high[j] * d[k] - way * d[j];
    precise double b1 = from_low[j] * d[k] + way * d[j];
    int corner = is_high ? 1 << k : 0;
    double at_0 = voxel_between(double(v.corner[corner]), double(v.corner[corner + (1 << i)]), a1, a0);
    double at_1 =
        voxel_between(double(v.corner[corner + (1 << j)]), double(v.corner[corner + (1 << i) + (1 << j)]), a1, a0);
    return voxel_sign(voxel_between(at_0, at_1, b1, b0));
}

void voxel_float64(Voxel v, vec3 o, vec3 direction, float tmin, float tmax, out VoxelHits hits) {
    hits = VoxelHits(0, 0.0);
    dvec3 d = dvec3(direction);
    precise float foot = dot(0.5 * v.low + 0.5 * v.high - o, direction) / dot(direction, direction);
    double start = double(foot);
    double from_low[3];
    double to_high[3];
    double enter = -1e300LF;
    double leave = 1e300LF;
    int enters_at = 0;
    int leaves_at = 0;
    bool has_first = true;
    bool has_last = true;
    for (int k = 0; k < 3; k++) {
        precise double there = double(o[k]) + start * d[k];
        precise double below = there - double(v.low[k]);
        precise double above = double(v.high[k]) - there;
        from_low[k] = below;
        to_high[k] = above;
        if (d[k] == 0.0LF) {
            if (below < 0.0LF || above <= 0.0LF) {
                return;
            }
            continue;
        }
        bool rises = d[k] > 0.0LF;
        double first = (rises ? -below : above) / d[k];
        double last = (rises ? above : -below) / d[k];
        has_first = first > enter ? rises : has_first && (rises || first < enter);
        has_last = last < leave ? !rises : has_last && (!rises || last > leave);
        enters_at = first > enter ? k : enters_at;
        leaves_at = last < leave ? k : leaves_at;
        enter = max(enter, first);
        leave = min(leave, last);
    }
    precise double first_t = double(tmin) - start;
    precise double last_t = double(tmax) - start;
    if (first_t >= enter) {
        enter = first_t;
        enters_at = -1;
        has_first = false;
    }
    if (last_t < leave) {
        leave = last_t;
        leaves_at = -1;
        has_last = true;
    }
    if (leave < enter) {
        return;
    }
    double x[8];
    for (int n = 0; n < 4; n++) {
        double low = double(v.corner[2 * n]);
        double high = double(v.corner[2 * n + 1]);
        x[2 * n] = voxel_between(low, high, from_low[0], to_high[0]);
        x[2 * n + 1] = (high - low) * d.x;
    }
    double y[6];
    for (int n = 0; n < 2; n++) {
        int m = 4 * n;
        y[3 * n] = voxel_between(x[m], x[m + 2], from_low[1], to_high[1]);
        precise double linear = voxel_between(x[m + 1], x[m + 3], from_low[1], to_high[1]) + (x[m + 2] - x[m]) * d.y;
        y[3 * n + 1] = linear;
        y[3 * n + 2] = (x[m + 3] - x[m + 1]) * d.y;
    }
    double c[4];
    for (int n = 0; n < 4; n++) {
        double from_mean = n < 3 ? voxel_between(y[n], y[n + 3], from_low[2], to_high[2]) : 0.0LF;
        double from_step = n > 0 ? (y[n + 2] - y[n - 1]) * d.z : 0.0LF;
        c[n] = from_mean + from_step;
    }
    if (c[0] == 0.0LF && c[1] == 0.0LF && c[2] == 0.0LF && c[3] == 0.0LF) {
        return;
    }
    double places[4] = double[4](enter, enter, enter, enter);
    int faces[2];
    for (int n = 0; n < 2; n++) {
        int k = n == 0 ? enters_at : leaves_at;
        int axis = max(k, 0);
        faces[n] = k < 0 ? voxel_sign(voxel_at(c, n == 0 ? enter : leave))
                         : voxel_sign_at_face(v, from_low, to_high, d, axis, (direction[axis] > 0.0) == (n == 1));
    }
    int signs[4] = int[4](faces[0], 0, 0, 0);
    int count = 1;
    precise double p = c[2] * c[2] - 3.0LF * c[3] * c[1];
    if (p > 0.0LF) {
        double root = sqrt(p);
        double s = c[2] >= 0.0LF ? -c[2] - root : root - c[2];
        double a = c[1] / s;
        double b = c[3] != 0.0LF ? s / (3.0LF * c[3]) : a;
        double ends[2] = double[2](min(a, b), max(a, b));
        precise double q = c[2] * c[1] - 9.0LF * c[0] * c[3];
        precise double r = c[1] * c[1] - 3.0LF * c[0] * c[2];
        precise double discriminant = 4.0LF * p * r - q * q;
        double values[2] = double[2](voxel_at(c, ends[0]), voxel_at(c, ends[1]));
        int touched = abs(values[0]) <= abs(values[1]) ? 0 : 1;
        for (int n = 0; n < (c[3] != 0.0LF ? 2 : 1); n++) {
            if (enter < ends[n] && ends[n] < leave) {
                places[count] = ends[n];
                signs[count] = discriminant == 0.0LF && n == touched ? 0 : voxel_sign(values[n]);
                count++;
            }
        }
    }
    places[count] = leave;
    signs[count] = faces[1];
    bool is_long = enter < leave;
    for (int n = 0; n <= count; n++) {
        bool is_between = n > 0 && signs[n - 1] * signs[n] < 0;
        bool is_there = signs[n] == 0 && (n == 0 ? has_first && (is_long || has_last) : n < count || has_last && is_long);
        if (!is_between && !is_there) {
            continue;
        }
        precise double t = start + (is_there ? places[n] : voxel_root(c, places[n - 1], places[n], signs[n - 1]));
        hits.t = hits.count == 0 ? float(t) : hits.t;
        hits.count++;
    }
}
