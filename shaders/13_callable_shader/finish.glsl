// Two colours, mixed by a pattern.

void mix_colors(inout PatternHit seen, Finish finish, float weight) {
    seen.weight = weight;
    seen.hit.color = finish.first + weight * (finish.second - finish.first);
}
