//! Micro-triangles: their order, and the texels that determine the state of one.

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{
    BLUE, BROWN, DEVICE, FAINT, GREEN, LEAF, LINE, Point, RED, SEA, Sheet, WHITE, YOURS,
};

/// The fills of a triangle's four parts.
const PARTS: [&str; 4] = [BLUE, GREEN, YOURS, DEVICE];

fn middle(a: Point, b: Point) -> Point {
    [0, 1].map(|i| (a[i] + b[i]) / 2.0)
}

/// The micro-triangles of a triangle, in order.
fn cut([a, b, c]: [Point; 3], level: u32) -> Vec<[Point; 3]> {
    if level == 0 {
        return vec![[a, b, c]];
    }
    let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    [[a, ab, ca], [ca, bc, ab], [ab, b, bc], [bc, ca, c]]
        .into_iter()
        .flat_map(|part| cut(part, level - 1))
        .collect()
}

fn center([a, b, c]: [Point; 3]) -> Point {
    [0, 1].map(|i| (a[i] + b[i] + c[i]) / 3.0)
}

/// Three levels, with numbers where they fit, and the path from each micro-triangle to the next.
pub fn order() -> String {
    let mut s = Sheet::new([840, 340], "The order of the micro-triangles, level 1 to 3");
    for (k, level) in [1, 2, 3].into_iter().enumerate() {
        let left = 36.0 + 272.0 * k as f64;
        let (bottom, side) = (290.0, 224.0);
        let corners =
            [[left, bottom], [left + side, bottom], [left + side / 2.0, bottom - side * 0.866]];
        let parts = cut(corners, level);
        for (i, &part) in parts.iter().enumerate() {
            s.polygon(&part, PARTS[4 * i / parts.len()], LINE);
        }
        let way: Vec<Point> = parts.iter().map(|&part| center(part)).collect();
        if level == 3 {
            s.line(&way, RED, 2.0);
            s.dot(way[0], 4.0, LEAF);
            s.dot(way[way.len() - 1], 4.0, RED);
        } else {
            for (i, [x, y]) in way.into_iter().enumerate() {
                s.strong([x, y + 4.5], Middle, &i.to_string());
            }
        }
        if level == 1 {
            let [a, b, c] = corners;
            s.note([a[0], a[1] + 18.0], Middle, "A");
            s.note([b[0], b[1] + 18.0], Middle, "B");
            s.note([c[0], c[1] - 8.0], Middle, "C");
        }
        let text = ["4 parts", "16 parts", "64 parts: the way from 0 to 63"][k];
        s.say([left + side / 2.0, bottom + 38.0], Middle, text);
    }
    s.svg()
}

/// The texels that lookups over a micro-triangle may read.
pub fn bound() -> String {
    let mut s = Sheet::new([840, 372], "What lookups over one micro-triangle can read");
    let (left, top, texel) = (28.0, 64.0, 28.0);
    let at = |x: f64, y: f64| -> Point { [left + texel * x, top + texel * y] };
    // Wood above a slanting edge, a hole below.
    let is_wood = |x: i32, y: i32| 3 * y + 2 * x < 21;
    let corners = [[1.75, 1.8], [4.7, 1.95], [1.9, 4.75]];
    let margin = 0.15;
    let bound = |axis: usize, pick: fn(f64, f64) -> f64, start| {
        corners.iter().map(|corner| corner[axis]).fold(start, pick)
    };
    let low = [0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY) - margin);
    let high = [0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY) + margin);
    let first = low.map(|x| (x - 0.5 - 1.0 / 16.0).floor() as i32);
    let last = high.map(|x| (x - 0.5 + 1.0 / 16.0).floor() as i32 + 1);
    for y in 0..10 {
        for x in 0..14 {
            let [x0, y0] = [f64::from(x), f64::from(y)];
            let square = [at(x0, y0), at(x0 + 1.0, y0), at(x0 + 1.0, y0 + 1.0), at(x0, y0 + 1.0)];
            s.polygon(&square, if is_wood(x, y) { YOURS } else { WHITE }, FAINT);
        }
    }
    let frame =
        |[a, b]: [f64; 2], [c, d]: [f64; 2]| [at(a, b), at(c, b), at(c, d), at(a, d), at(a, b)];
    s.line(&frame(first.map(f64::from), last.map(|x| f64::from(x) + 1.0)), RED, 2.6);
    s.dashes(&frame(low, high), SEA, 1.8);
    let [a, b, c] = corners.map(|[x, y]| at(x, y));
    s.line(&[a, b, c, a], BROWN, 2.4);
    for y in first[1]..=last[1] {
        for x in first[0]..=last[0] {
            s.dot(at(f64::from(x) + 0.5, f64::from(y) + 0.5), 2.0, LINE);
        }
    }

    let x = 462.0;
    let row = |s: &mut Sheet, y: f64, color: &str, lines: [&str; 2]| {
        s.line(&[[x, y - 4.0], [x + 26.0, y - 4.0]], color, 2.6);
        s.say([x + 40.0, y], Start, lines[0]);
        s.say([x + 40.0, y + 18.0], Start, lines[1]);
    };
    row(&mut s, 92.0, BROWN, ["the micro-triangle, in texels", ""]);
    row(&mut s, 124.0, SEA, ["the box around it,", "and around all that rounding can add"]);
    row(
        &mut s,
        178.0,
        RED,
        ["the texels that a lookup in the box can read:", "the middles on both sides of it"],
    );
    let square = |s: &mut Sheet, y: f64, fill: &str| {
        s.polygon(&[[x, y], [x + 24.0, y], [x + 24.0, y + 18.0], [x, y + 18.0]], fill, LINE);
    };
    square(&mut s, 228.0, YOURS);
    s.say([x + 40.0, 242.0], Start, "surely opaque: alpha at least 0.52");
    square(&mut s, 258.0, WHITE);
    s.say([x + 40.0, 272.0], Start, "surely transparent: alpha at most 0.48");
    s.strong([x, 312.0], Start, "Within red both kinds: the state is unknown.");
    s.say([x, 332.0], Start, "One kind alone would be the state.");
    s.svg()
}
