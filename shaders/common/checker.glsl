// Taught by 43_filtered_checker.
//
// A checker board, averaged over what a pixel sees of it.

// The light fraction of a box. `middle` and `width` of the box are in squares; the square between 0 and
// 1 in both is light. A stripe pattern of +1 and -1 has the triangle wave for its integral; a checker
// board is the product of two such patterns, and so is its mean over a box.
// (Quilez, "Filterable procedurals"; the box filter as in Apodaca and Gritz, Advanced RenderMan, 2000.)
float checker_light(vec2 middle, vec2 width) {
    // A thousandth of a square is as sharp as anyone can see, and beyond a million all is grey. Between
    // the two, the difference below has enough bits left.
    width = clamp(width, vec2(1.0 / 1024.0), vec2(1e6));
    vec2 from = abs(fract(0.5 * (middle - 0.5 * width)) - 0.5);
    vec2 to = abs(fract(0.5 * (middle + 0.5 * width)) - 0.5);
    vec2 mean = clamp(2.0 * (from - to) / width, vec2(-1.0), vec2(1.0));
    return 0.5 + 0.5 * mean.x * mean.y;
}
