// Two colours, mixed by a pattern.

void mix_colors(inout Hit hit, Finish finish, float weight) {
    hit.weight = weight;
    hit.color = finish.first + weight * (finish.second - finish.first);
}
