// A ray against a voxel of a distance grid: a box with a distance at each corner, and in it their trilinear mean. The surface
// is where the mean is 0.
//
// Along a ray the mean is a polynomial of degree three (Hansson-Söderholm, Evans and Akenine-Möller 2022). A voxel has its low
// faces and not its high ones, so that a hit in the face between two voxels counts once. A touch counts once, and a ray along
// which the mean is 0 has no hit. `precise`: rounding is what this is about, so no compiler may rearrange it.

#include "cardano.glsl"

const uint VOXEL_MARCH = 0;
const uint VOXEL_CARDANO = 1;
const uint VOXEL_BRACKETED = 2;

struct Voxel {
    vec3 low;
    vec3 high;
    float corner[8];   // x first, then y, then z
};

struct VoxelHits {
    uint count;
    float t;   // of the first
};

// Where a ray is in the box, and whether its first and its last point belong to the voxel.
struct VoxelSpan {
    float enter;
    float leave;
    bool has_first;
    bool has_last;
};

void voxel_meet(inout VoxelHits hits, float t, float tmin, float tmax) {
    if (t > tmin && t <= tmax) {
        hits.t = hits.count == 0 ? t : min(hits.t, t);
        hits.count++;
    }
}

bool voxel_span(Voxel v, vec3 o, vec3 d, out VoxelSpan span) {
    span = VoxelSpan(-1e38, 1e38, true, true);
    for (int k = 0; k < 3; k++) {
        if (d[k] == 0.0) {
            if (o[k] < v.low[k] || o[k] >= v.high[k]) {
                return false;
            }
            continue;
        }
        precise float at_low = (v.low[k] - o[k]) / d[k];
        precise float at_high = (v.high[k] - o[k]) / d[k];
        bool rises = d[k] > 0.0;
        float enter = rises ? at_low : at_high;
        float leave = rises ? at_high : at_low;
        span.has_first = enter > span.enter ? rises : span.has_first && (rises || enter < span.enter);
        span.has_last = leave < span.leave ? !rises : span.has_last && (!rises || leave > span.leave);
        span.enter = max(span.enter, enter);
        span.leave = min(span.leave, leave);
    }
    return span.enter <= span.leave;
}

// The mean at a place from 0 to 1 along each edge.
float voxel_mean(Voxel v, vec3 at) {
    precise vec4 along_x = mix(vec4(v.corner[0], v.corner[2], v.corner[4], v.corner[6]),
        vec4(v.corner[1], v.corner[3], v.corner[5], v.corner[7]), at.x);
    precise vec2 along_y = mix(along_x.xz, along_x.yw, at.y);
    precise float mean = mix(along_y.x, along_y.y, at.z);
    return mean;
}

vec3 voxel_gradient(Voxel v, vec3 at) {
    vec4 low = vec4(v.corner[0], v.corner[2], v.corner[4], v.corner[6]);
    vec4 high = vec4(v.corner[1], v.corner[3], v.corner[5], v.corner[7]);
    vec4 along_x = mix(low, high, at.x);
    vec2 steps = mix(high.xz - low.xz, high.yw - low.yw, at.y);
    vec2 along_y = mix(along_x.xz, along_x.yw, at.y);
    return vec3(mix(steps.x, steps.y, at.z), mix(along_x.y - along_x.x, along_x.w - along_x.z, at.z), along_y.y - along_y.x)
        / (v.high - v.low);
}

// Thirty-two steps of one length, and a straight line across the step in which the sign changes.
VoxelHits voxel_march(Voxel v, vec3 o, vec3 d, float tmin, float tmax) {
    VoxelHits hits = VoxelHits(0, 0.0);
    VoxelSpan span;
    if (!voxel_span(v, o, d, span)) {
        return hits;
    }
    precise float stride = (span.leave - span.enter) / 32.0;
    float t = span.enter;
    float mean = voxel_mean(v, (o + t * d - v.low) / (v.high - v.low));
    for (int i = 1; i <= 32; i++) {
        precise float next_t = span.enter + float(i) * stride;
        float next = voxel_mean(v, (o + next_t * d - v.low) / (v.high - v.low));
        if ((mean >= 0.0) != (next >= 0.0)) {
            precise float crossing = t + (next_t - t) * mean / (mean - next);
            voxel_meet(hits, crossing, tmin, tmax);
        }
        t = next_t;
        mean = next;
    }
    return hits;
}

// The coefficients of 1, t, t² and t³ for a ray that starts at `at` and goes along `d`, in edges.
vec4 voxel_cubic(Voxel v, vec3 at, vec3 d) {
    vec4 low = vec4(v.corner[0], v.corner[2], v.corner[4], v.corner[6]);
    vec4 high = vec4(v.corner[1], v.corner[3], v.corner[5], v.corner[7]);
    precise vec4 x0 = low + at.x * (high - low);
    precise vec4 x1 = d.x * (high - low);
    precise vec2 y0 = x0.xz + at.y * (x0.yw - x0.xz);
    precise vec2 y1 = x1.xz + at.y * (x1.yw - x1.xz) + d.y * (x0.yw - x0.xz);
    precise vec2 y2 = d.y * (x1.yw - x1.xz);
    precise vec4 c = vec4(y0.x + at.z * (y0.y - y0.x), y1.x + at.z * (y1.y - y1.x) + d.z * (y0.y - y0.x),
        y2.x + at.z * (y2.y - y2.x) + d.z * (y1.y - y1.x), d.z * (y2.y - y2.x));
    return c;
}

// It divides by c.w.
VoxelHits voxel_cardano(Voxel v, vec3 o, vec3 d, float tmin, float tmax) {
    VoxelHits hits = VoxelHits(0, 0.0);
    VoxelSpan span;
    if (!voxel_span(v, o, d, span)) {
        return hits;
    }
    vec3 size = v.high - v.low;
    vec4 c = voxel_cubic(v, (o + span.enter * d - v.low) / size, d / size);
    if (c.w == 0.0) {
        return hits;
    }
    precise vec3 n = c.xyz / c.w;
    float roots[3];
    int count = cubic_roots(n, roots);
    for (int i = 0; i < count; i++) {
        precise float t = span.enter + roots[i];
        if (roots[i] >= 0.0 && t < span.leave) {
            voxel_meet(hits, t, tmin, tmax);
        }
    }
    return hits;
}

float voxel_at(vec4 c, float t) {
    precise float value = ((c.w * t + c.z) * t + c.y) * t + c.x;
    return value;
}

// The root between two places with different signs: Newton's steps, and half of the interval where they leave it.
float voxel_root(vec4 c, float low, float high, bool is_low_above) {
    float t = 0.5 * (low + high);
    for (int i = 0; i < 40; i++) {
        float value = voxel_at(c, t);
        if (value == 0.0) {
            break;
        }
        if ((value > 0.0) == is_low_above) {
            low = t;
        } else {
            high = t;
        }
        precise float slope = (3.0 * c.w * t + 2.0 * c.z) * t + c.y;
        precise float next = t - value / slope;
        next = next > low && next < high ? next : 0.5 * (low + high);
        if (next == t) {
            break;
        }
        t = next;
    }
    return t;
}

// ANCHOR: bracketed
// Between the places where its derivative is 0 the polynomial rises or falls, so a change of sign is one root.
VoxelHits voxel_bracketed(Voxel v, vec3 o, vec3 d, float tmin, float tmax) {
    VoxelHits hits = VoxelHits(0, 0.0);
    VoxelSpan span;
    if (!voxel_span(v, o, d, span)) {
        return hits;
    }
    vec3 size = v.high - v.low;
    vec4 c = voxel_cubic(v, (o + span.enter * d - v.low) / size, d / size);
    if (c == vec4(0.0)) {
        return hits;
    }
    precise float end = span.leave - span.enter;
    float places[4] = float[4](0.0, 0.0, 0.0, 0.0);
    int count = 1;
    precise float discriminant = c.z * c.z - 3.0 * c.w * c.y;
    if (discriminant > 0.0) {
        precise float root = sqrt(discriminant);
        precise float s = c.z >= 0.0 ? -c.z - root : root - c.z;
        precise float a = c.y / s;
        precise float b = c.w != 0.0 ? s / (3.0 * c.w) : a;
        float first = min(a, b);
        float last = max(a, b);
        if (first > 0.0 && first < end) {
            places[count++] = first;
        }
        if (last > first && last > 0.0 && last < end) {
            places[count++] = last;
        }
    }
    places[count++] = end;
    float value = c.x;
    if (value == 0.0 && span.has_first && (end > 0.0 || span.has_last)) {
        voxel_meet(hits, span.enter, tmin, tmax);
    }
    for (int i = 1; i < count; i++) {
        float next = voxel_at(c, places[i]);
        bool is_end = i == count - 1;
        if (next == 0.0 && (!is_end || span.has_last && end > 0.0)) {
            voxel_meet(hits, span.enter + places[i], tmin, tmax);
        } else if (value > 0.0 && next < 0.0 || value < 0.0 && next > 0.0) {
            precise float t = span.enter + voxel_root(c, places[i - 1], places[i], value > 0.0);
            voxel_meet(hits, t, tmin, tmax);
        }
        value = next;
    }
    return hits;
}
// ANCHOR_END: bracketed
