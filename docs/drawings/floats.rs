//! The 32-bit floats far from the origin and near it.

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BROWN, LINE, Point, RED, Sheet};

/// Eye and piece, in f64: offsets from a million units.
const EYE: f64 = 0.146;
const PIECE: f64 = 0.602;
/// Pixels of the drawing per unit, and the place of the first number.
const UNIT: f64 = 920.0;
const LEFT: f64 = 60.0;

fn x(place: f64) -> f64 {
    LEFT + UNIT * place
}

/// The offset left after rounding a million units plus `place`.
fn snapped(place: f64) -> f64 {
    f64::from((1e6 + place) as f32) - 1e6
}

/// The difference of two places, rounded before the subtraction, and after it.
pub fn subtract_first() -> String {
    let mut s = Sheet::new([840, 374], "Rounded first, or subtracted first");
    let (first, second) = (104.0, 268.0);
    s.title([LEFT, 66.0], Start, "World coordinates: round, then subtract");
    ruler(&mut s, first, 1.0 / 16.0);
    for (place, name) in [(EYE, "eye"), (PIECE, "piece")] {
        s.dot([x(place), first], 5.0, BROWN);
        s.say([x(place), first - 14.0], Middle, name);
        s.arrow(&[[x(place), first + 10.0], [x(snapped(place)), first + 30.0]]);
        s.dot([x(snapped(place)), first + 36.0], 5.0, RED);
    }
    span(&mut s, first + 58.0, [snapped(EYE), snapped(PIECE)], RED);
    let rounded = snapped(PIECE) - snapped(EYE);
    let text = format!("{rounded} instead of {:.3}", PIECE - EYE);
    s.say([x(0.375), first + 78.0], Middle, &text);
    s.note([x(0.0), first + 36.0], Middle, "1,000,000");
    s.note([x(0.75), first + 36.0], Middle, "1,000,000.75");

    s.title([LEFT, 230.0], Start, "Camera-relative ones: subtract in 64 bits, then round");
    // Near 0, floats are a million times as dense. These are fewer than there are, because all would be too
    // many to draw.
    ruler(&mut s, second, 1.0 / 256.0);
    for (place, name) in [(EYE, "eye"), (PIECE, "piece")] {
        s.dot([x(place), second], 5.0, BROWN);
        s.say([x(place), second - 14.0], Middle, name);
    }
    span(&mut s, second + 30.0, [EYE, PIECE], BROWN);
    let text = format!("{:.3}, and five digits more", PIECE - EYE);
    s.say([x(0.375), second + 50.0], Middle, &text);
    s.note(
        [LEFT, second + 84.0],
        Start,
        "Every stroke above is a float. Below there are thousands to a stroke.",
    );
    s.svg()
}

/// A line with a tick for each number.
fn ruler(s: &mut Sheet, y: f64, step: f64) {
    s.line(&[[x(0.0), y], [x(0.75), y]], LINE, 1.4);
    let count = (0.75 / step) as u32;
    for i in 0..=count {
        let at = x(f64::from(i) * step);
        s.line(&[[at, y - 6.0], [at, y + 6.0]], LINE, if step < 0.01 { 0.6 } else { 1.4 });
    }
}

/// A distance with ends.
fn span(s: &mut Sheet, y: f64, [from, to]: [f64; 2], color: &str) {
    let ends: [Point; 2] = [[x(from), y], [x(to), y]];
    s.line(&ends, color, 2.0);
    for [at, y] in ends {
        s.line(&[[at, y - 5.0], [at, y + 5.0]], color, 2.0);
    }
}
