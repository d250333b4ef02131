// The list of a pixel's hits, once the trace has filled it.

// ANCHOR: sort
bool before(ListedHit a, ListedHit b) {
    if (a.t != b.t) {
        return a.t < b.t;
    }
    return a.instance != b.instance ? a.instance < b.instance : a.triangle < b.triangle;
}

// Sorts by distance, because the device finds hits in any order. Insertion sort, in place.
void sort_list(uint first, uint count) {
    for (uint i = 1; i < count; i++) {
        ListedHit hit = push.hits.at[first + i];
        uint j = i;
        for (; j > 0 && before(hit, push.hits.at[first + j - 1]); j--) {
            push.hits.at[first + j] = push.hits.at[first + j - 1];
        }
        push.hits.at[first + j] = hit;
    }
}
// ANCHOR_END: sort

// Few hits are dark blue, many are light: an X-ray picture.
vec3 heat(float x) {
    vec3 low = mix(vec3(0.01, 0.01, 0.03), vec3(0.03, 0.16, 0.36), min(3.0 * x, 1.0));
    vec3 middle = mix(low, vec3(0.20, 0.62, 0.75), clamp(3.0 * x - 1.0, 0.0, 1.0));
    return mix(middle, vec3(1.0, 0.96, 0.85), clamp(3.0 * x - 2.0, 0.0, 1.0));
}

// The view of a list: the count as a heat map, or the surface at one depth.
vec4 show_list(uint pixel, uint count) {
    uint first = pixel * MAX_HITS;
    uint listed = min(count, MAX_HITS);
    sort_list(first, listed);
    if (SHOW == SHOW_PICTURE || SHOW == SHOW_NORMAL) {
        return vec4(heat(float(count) / 12.0), 1.0);
    }
    if (push.layer >= listed) {
        return SHOW == SHOW_HIT ? vec4(-1.0, -1.0, -1.0, count) : vec4(0.0, 0.0, 0.0, 1.0);
    }
    ListedHit hit = push.hits.at[first + push.layer];
    if (SHOW == SHOW_HIT) {
        return vec4(hit.instance, hit.triangle, hit.t, count);
    }
    return vec4(false_color(hit.triangle), 1.0);
}
