//! The life of a reservoir: candidates, the last frame, neighbours, and the next frame.

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, BROWN, LINE, RED, SEA, Sheet, WHITE, YOURS};

/// The light of each candidate, and whether the reservoir takes it when it comes.
const CANDIDATES: [(f64, bool); 8] = [
    (0.25, true),
    (0.1, false),
    (0.7, true),
    (0.15, false),
    (0.3, false),
    (1.0, true),
    (0.2, false),
    (0.4, false),
];

/// A reservoir: its lamp, and the number of candidates that it speaks for.
fn reservoir(s: &mut Sheet, [x, y]: [f64; 2], color: &str, count: &str) {
    let corners =
        [[x - 17.0, y - 20.0], [x + 17.0, y - 20.0], [x + 13.0, y + 20.0], [x - 13.0, y + 20.0]];
    s.polygon(&corners, WHITE, LINE);
    s.dot([x, y + 4.0], 8.0, color);
    s.note([x, y + 36.0], Middle, count);
}

/// From eight candidates to the light of a pixel.
pub fn life() -> String {
    let mut s = Sheet::new([840, 330], "The life of a reservoir");
    s.title([24.0, 66.0], Start, "candidates");
    s.title([306.0, 66.0], Start, "in time");
    s.title([560.0, 66.0], Start, "in space");
    for (i, (light, is_taken)) in CANDIDATES.iter().enumerate() {
        let x = 36.0 + 25.0 * i as f64;
        let color = if i == 5 {
            SEA
        } else if *is_taken {
            BROWN
        } else {
            LINE
        };
        s.dot([x, 104.0], 2.5 + 7.0 * light.sqrt(), color);
        if *is_taken {
            s.line(&[[x, 116.0], [x, 124.0]], color, 2.0);
        }
    }
    s.note([24.0, 144.0], Start, "size: light that would arrive");
    s.note([24.0, 160.0], Start, "mark: taken, until another one is");
    reservoir(&mut s, [136.0, 214.0], SEA, "8");
    s.arrow(&[[136.0, 170.0], [136.0, 191.0]]);
    s.note([164.0, 218.0], Start, "shadow ray: sees it");

    reservoir(&mut s, [330.0, 110.0], RED, "160");
    s.note([356.0, 106.0], Start, "kept in the last frame,");
    s.note([356.0, 122.0], Start, "its count capped");
    reservoir(&mut s, [420.0, 214.0], RED, "168");
    s.arrow(&[[296.0, 214.0], [398.0, 214.0]]);
    s.arrow(&[[344.0, 134.0], [400.0, 196.0]]);

    for (i, color) in [BLUE, BROWN, SEA].into_iter().enumerate() {
        let x = 584.0 + 62.0 * i as f64;
        reservoir(&mut s, [x, 110.0], color, "168");
        s.arrow(&[[x, 150.0], [650.0 + 12.0 * (i as f64 - 1.0), 191.0]]);
    }
    s.note([752.0, 114.0], Start, "neighbours");
    reservoir(&mut s, [650.0, 214.0], BLUE, "672");
    s.arrow(&[[442.0, 214.0], [626.0, 214.0]]);
    s.card([724.0, 190.0], [92.0, 48.0], YOURS, "light", &["of the pixel"]);
    s.arrow(&[[672.0, 214.0], [722.0, 214.0]]);
    s.dashed_arrow(&[
        [650.0, 256.0],
        [650.0, 290.0],
        [284.0, 290.0],
        [284.0, 110.0],
        [310.0, 110.0],
    ]);
    s.note([466.0, 308.0], Middle, "the next frame's history");
    s.svg()
}
