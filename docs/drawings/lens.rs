//! A thin lens, from the side.

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, BROWN, LINE, Point, Sheet, YOURS};

/// The lens's diameter and the distance of the plane in focus, in pixels of the drawing.
const DIAMETER: f64 = 120.0;
const FOCUS: f64 = 150.0;

/// Three lights in front of, in and behind the plane in focus, and their images.
pub fn thin_lens() -> String {
    let mut s = Sheet::new([840, 330], "How far a light is spread: the circle of confusion");
    let panels = [
        ("behind the plane in focus", 212.0, "The rays to it cross the plane", "before they meet."),
        ("in focus", FOCUS, "All rays of one point", "meet in it."),
        ("before the plane in focus", 90.0, "The rays to it have met,", "and part again."),
    ];
    let axis = 150.0;
    for (k, (title, depth, first, second)) in panels.into_iter().enumerate() {
        let left = 46.0 + 272.0 * k as f64;
        s.title([left - 20.0, 66.0], Start, title);
        lens(&mut s, [left, axis]);
        let plane = left + FOCUS;
        s.dashes(&[[plane, axis - 70.0], [plane, axis + 70.0]], LINE, 1.4);
        // The rays from both rims through the light cross the plane according to similar triangles.
        let light = [left + depth, axis];
        let half = DIAMETER / 2.0 * (depth - FOCUS) / depth;
        for rim in [-DIAMETER / 2.0, DIAMETER / 2.0] {
            let from = [left, axis + rim];
            let crossing = [plane, axis + rim * (depth - FOCUS) / depth];
            let end = if depth > FOCUS { light } else { crossing };
            s.line(&[from, end], LINE, 1.2);
        }
        s.line(&[[plane, axis - half], [plane, axis + half]], BROWN, 4.0);
        s.dot(light, 5.0, YOURS);
        s.circle(light, 5.0, YOURS, BROWN);
        if half.abs() > 1.0 {
            s.say([plane + 10.0, axis - half.abs() - 6.0], Start, "c");
        }
        s.say([left - 22.0, axis - 44.0], Start, "A");
        measure(&mut s, [left, 236.0], FOCUS, "S₁");
        if half.abs() > 1.0 {
            measure(&mut s, [left, 258.0], depth, "S₂");
        }
        s.note([left - 20.0, 290.0], Start, first);
        s.note([left - 20.0, 308.0], Start, second);
    }
    s.svg()
}

/// Two arcs that meet at the rims.
fn lens(s: &mut Sheet, [x, y]: Point) {
    let arc = |side: f64| {
        (-12..=12).map(move |i| {
            let part = f64::from(i) / 12.0;
            [x + side * 9.0 * (1.0 - part * part), y + side * part * DIAMETER / 2.0]
        })
    };
    let outline: Vec<Point> = arc(1.0).chain(arc(-1.0)).collect();
    s.polygon(&outline, BLUE, LINE);
}

/// A dimension line below the measured length.
fn measure(s: &mut Sheet, [x, y]: Point, length: f64, name: &str) {
    s.line(&[[x, y], [x + length, y]], LINE, 1.0);
    for end in [x, x + length] {
        s.line(&[[end, y - 4.0], [end, y + 4.0]], LINE, 1.0);
    }
    s.say([x + length / 2.0, y - 4.0], Middle, name);
}
