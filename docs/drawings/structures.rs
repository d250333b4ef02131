//! Acceleration structures: the two levels, the path from a hit to its vertices, and the effect of an update
//! on a tree.

use crate::sheet::Anchor::{End, Middle, Start};
use crate::sheet::{BLUE, BROWN, DEVICE, GREEN, LINE, Point, RED, Sheet, WHITE, YOURS};

/// A top level over three bottom levels.
pub fn two_levels() -> String {
    let mut s = Sheet::new([840, 400], "Acceleration structures");
    s.card([24.0, 52.0], [792.0, 126.0], BLUE, "", &[]);
    s.title([40.0, 76.0], Start, "Top level (TLAS)");
    s.note([800.0, 76.0], End, "one per scene: a tree over instances");
    let instances = ["white rook", "white rook", "black rook", "pawn", "light squares"];
    for (number, piece) in instances.into_iter().enumerate() {
        let x = 40.0 + 154.0 * number as f64;
        let title = format!("instance {number}");
        s.card([x, 92.0], [144.0, 72.0], WHITE, &title, &[piece, "matrix, mask, index"]);
    }
    s.card([24.0, 250.0], [792.0, 126.0], GREEN, "", &[]);
    s.title([40.0, 362.0], Start, "Bottom levels (BLAS)");
    s.note(
        [800.0, 362.0],
        End,
        "one per mesh: a tree over triangles or boxes, in the mesh’s own space",
    );
    s.card([117.0, 266.0], [298.0, 66.0], WHITE, "rook", &["2952 triangles"]);
    s.card([502.0, 266.0], [144.0, 66.0], WHITE, "pawn", &["2128 triangles"]);
    s.card([656.0, 266.0], [144.0, 66.0], WHITE, "light squares", &["64 triangles"]);
    for (from, to) in
        [(112.0, 190.0), (266.0, 266.0), (420.0, 342.0), (574.0, 574.0), (728.0, 728.0)]
    {
        s.arrow(&[[from, 164.0], [to, 264.0]]);
    }
    s.svg()
}

/// From the push constants and the hit to three vertices.
pub fn address_chain() -> String {
    let mut s = Sheet::new([840, 360], "From a hit to its vertices");
    s.card([24.0, 96.0], [126.0, 64.0], DEVICE, "push constants", &["scene.instances"]);
    s.card([24.0, 246.0], [126.0, 64.0], GREEN, "the hit", &["from the device"]);
    let corners = ["0: position, …", "1: position, …", "2: position, …", "3: position, …"];
    // The position, width, name and rows of each, and the chosen rows.
    type Column<'a> = (f64, f64, &'a str, [&'a str; 4], &'a [usize]);
    let columns: [Column; 4] = [
        (180.0, 150.0, "InstanceRecord", ["0", "1", "2", "…"], &[2]),
        (382.0, 80.0, "original", ["2", "0", "1", "…"], &[2]),
        (514.0, 110.0, "triangles", ["(0, 1, 2)", "(2, 1, 3)", "(3, 1, 4)", "…"], &[1]),
        (676.0, 140.0, "vertices", corners, &[1, 2, 3]),
    ];
    let middle = |row: usize| 114.0 + 28.0 * row as f64;
    for (x, width, name, rows, chosen) in columns {
        s.title([x, 60.0], Start, name);
        for (row, text) in rows.iter().enumerate() {
            let fill = if chosen.contains(&row) { YOURS } else { WHITE };
            s.card([x, middle(row) - 14.0], [width, 28.0], fill, "", &[text]);
        }
    }
    s.arrow(&[[150.0, 128.0], [164.0, 128.0], [164.0, 108.0], [178.0, 108.0]]);
    // The three addresses of a record.
    for end in [422.0, 569.0, 746.0] {
        s.arrow(&[[330.0, middle(2)], [354.0, middle(2)], [354.0, 78.0], [end, 78.0], [end, 98.0]]);
    }
    s.dashed_arrow(&[[150.0, 278.0], [255.0, 278.0], [255.0, 214.0]]);
    s.dashed_arrow(&[[255.0, 278.0], [422.0, 278.0], [422.0, 214.0]]);
    s.note([255.0, 298.0], Middle, "gl_InstanceCustomIndexEXT");
    s.note([422.0, 298.0], Middle, "gl_PrimitiveID");
    s.dashed_arrow(&[
        [462.0, middle(2)],
        [488.0, middle(2)],
        [488.0, middle(1)],
        [512.0, middle(1)],
    ]);
    for row in 1..=3 {
        let bend = 650.0;
        s.dashed_arrow(&[
            [624.0, middle(1)],
            [bend, middle(1)],
            [bend, middle(row)],
            [674.0, middle(row)],
        ]);
    }
    s.note([24.0, 340.0], Start, "Solid arrows are addresses of 64 bits: where an array begins. Dashed arrows are indices: which element is meant.");
    s.svg()
}

/// The bounding box of some points, with a margin.
fn bounds(points: &[Point]) -> [Point; 2] {
    let pick = |axis: usize, by: fn(f64, f64) -> f64| {
        points.iter().map(|point| point[axis]).reduce(by).expect("points")
    };
    let m = 12.0;
    [[pick(0, f64::min) - m, pick(1, f64::min) - m], [pick(0, f64::max) + m, pick(1, f64::max) + m]]
}

/// Six pieces in three boxes: built, moved and updated, moved and rebuilt.
pub fn refit() -> String {
    let mut s = Sheet::new([840, 330], "An update keeps the tree and moves its boxes");
    let built: [Point; 6] = [
        [40.0, 150.0],
        [66.0, 190.0],
        [120.0, 90.0],
        [150.0, 120.0],
        [190.0, 200.0],
        [220.0, 170.0],
    ];
    let moved: [Point; 6] =
        [[200.0, 80.0], [52.0, 196.0], [60.0, 84.0], [190.0, 208.0], [226.0, 116.0], [88.0, 140.0]];
    let old = [[0, 1], [2, 3], [4, 5]];
    let new = [[0, 4], [2, 5], [1, 3]];
    let panels = [
        (24.0, "built", "small boxes", built, old),
        (290.0, "moved, then updated", "the same pairs: the boxes overlap", moved, old),
        (556.0, "moved, then built anew", "new pairs", moved, new),
    ];
    for (x, title, note, places, pairs) in panels {
        let at = |number: usize| [x + places[number][0], places[number][1] + 14.0];
        s.title([x, 66.0], Start, title);
        let mut area = 0.0;
        for pair in pairs {
            let [low, high] = bounds(&pair.map(at));
            area += (high[0] - low[0]) * (high[1] - low[1]);
            let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
            s.polygon(&corners, "none", if title.ends_with("updated") { RED } else { LINE });
        }
        for number in 0..6 {
            s.dot(at(number), 6.0, BROWN);
        }
        s.note([x, 266.0], Start, note);
        s.note([x, 284.0], Start, &format!("area of the boxes: {:.0}", area / 100.0));
    }
    s.note(
        [24.0, 310.0],
        Start,
        "A ray tests what is inside each box that it meets: the larger the boxes, the more tests.",
    );
    s.svg()
}
