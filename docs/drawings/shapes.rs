//! Shapes that a ray enters and leaves.

use glam::DVec3;
use reference::Ray;
use reference::solid::Solid;
use reference::sphere::Sphere;

use crate::sheet::Anchor::{self, Middle, Start};
use crate::sheet::{BLUE, BROWN, FAINT, GREEN, LINE, RED, SEA, Sheet, WHITE, YOURS};

/// A 2D box as two slabs.
pub fn slabs() -> String {
    let mut s = Sheet::new([840, 340], "A box is where slabs overlap");
    let (low, high) = ([230.0, 110.0], [390.0, 210.0]);
    s.polygon(&[[low[0], 50.0], [high[0], 50.0], [high[0], 250.0], [low[0], 250.0]], BLUE, "none");
    s.polygon(&[[60.0, low[1]], [560.0, low[1]], [560.0, high[1]], [60.0, high[1]]], GREEN, "none");
    s.polygon(&[low, [high[0], low[1]], high, [low[0], high[1]]], YOURS, LINE);
    let (origin, direction) = ([70.0, 236.0], [1.0, -0.42]);
    // t at which the ray enters and leaves each slab.
    let span = |axis: usize| {
        let at = |edge: f64| (edge - origin[axis]) / direction[axis];
        let (one, other) = (at(low[axis]), at(high[axis]));
        [f64::min(one, other), f64::max(one, other)]
    };
    let (x, y) = (span(0), span(1));
    let place = |t: f64| [origin[0] + t * direction[0], origin[1] + t * direction[1]];
    s.arrow(&[origin, place(470.0)]);
    s.dot(origin, 5.0, LINE);
    for t in x.into_iter().chain(y) {
        s.dot(place(t), 4.0, BROWN);
    }
    s.note([low[0] + 4.0, 64.0], Start, "slab of x");
    s.note([66.0, low[1] + 16.0], Start, "slab of y");
    let hit = [f64::max(x[0], y[0]), f64::min(x[1], y[1])];
    let rows = [
        ("in the slab of x", x, BLUE),
        ("in the slab of y", y, GREEN),
        ("in both: in the box", hit, YOURS),
    ];
    for (row, (name, [from, to], fill)) in rows.into_iter().enumerate() {
        let top = 262.0 + 24.0 * row as f64;
        s.line(&[[70.0, top + 9.0], [560.0, top + 9.0]], FAINT, 1.0);
        s.card([origin[0] + from, top], [to - from, 18.0], fill, "", &[]);
        s.say([580.0, top + 13.0], Start, name);
    }
    let lines = [
        "Along the ray each slab is an interval",
        "of t. The ray is in the box where both",
        "intervals overlap: from the last entry",
        "to the first exit. If the last entry comes",
        "after the first exit, the ray misses.",
    ];
    for (row, line) in lines.into_iter().enumerate() {
        s.say([586.0, 90.0 + 20.0 * row as f64], Start, line);
    }
    s.svg()
}

/// The foot of the perpendicular from a sphere's centre onto a ray, and half of the chord to either side.
pub fn foot() -> String {
    let mut s = Sheet::new([840, 330], "The foot of the perpendicular");
    let (center, radius) = ([430.0, 150.0], 92.0);
    let (origin, slope) = ([50.0, 232.0], -0.075f64);
    let length = slope.hypot(1.0);
    let unit = [1.0 / length, slope / length];
    let place = |t: f64| [origin[0] + t * unit[0], origin[1] + t * unit[1]];
    let middle = unit[0] * (center[0] - origin[0]) + unit[1] * (center[1] - origin[1]);
    let foot = place(middle);
    let aside = (center[0] - foot[0]).hypot(center[1] - foot[1]);
    let half_chord = (radius * radius - aside * aside).sqrt();
    let (near, far) = (place(middle - half_chord), place(middle + half_chord));
    s.circle(center, radius, YOURS, BROWN);
    s.arrow(&[origin, place(560.0)]);
    s.line(&[near, far], SEA, 4.0);
    s.dashes(&[center, foot], RED, 1.8);
    s.line(&[center, far], BROWN, 1.6);
    for (point, fill) in [(origin, LINE), (center, BROWN), (near, SEA), (far, SEA), (foot, RED)] {
        s.dot(point, 4.5, fill);
    }
    s.say([origin[0] - 4.0, origin[1] + 22.0], Start, "origin");
    s.say([center[0] - 10.0, center[1] - 8.0], Anchor::End, "centre");
    s.note([center[0] + 52.0, center[1] + 8.0], Start, "r");
    s.say([foot[0] + 4.0, foot[1] + 20.0], Middle, "foot");
    s.say([near[0] - 8.0, near[1] + 20.0], Anchor::End, "near hit");
    s.say([far[0] + 10.0, far[1] + 20.0], Start, "far hit");
    // A ruler for the two lengths along the ray.
    let below = |t: f64, down: f64| [place(t)[0], 276.0 + down];
    let ends = [0.0, middle - half_chord, middle, middle + half_chord];
    for end in ends {
        s.line(&[below(end, -6.0), below(end, 6.0)], LINE, 1.2);
    }
    s.line(&[below(0.0, 0.0), below(middle, 0.0)], LINE, 1.2);
    s.line(&[below(middle - half_chord, 0.0), below(middle + half_chord, 0.0)], SEA, 3.0);
    s.note(below(middle * 0.42, 20.0), Middle, "t of the foot: as large as the distance");
    s.note(below(middle + half_chord / 2.0, 20.0), Middle, "half the chord");
    let lines = [
        "The ray hits if the red line is",
        "at most r long. From any distance,",
        "the red line, r and half the chord",
        "stay as small as the sphere.",
        "",
        "The hits are half a chord before",
        "the foot and half a chord behind:",
        "half chord² = r² − red²",
    ];
    for (row, line) in lines.into_iter().enumerate() {
        s.say([612.0, 84.0 + 20.0 * row as f64], Start, line);
    }
    s.svg()
}

/// A ball minus another, intersected with a half-space: the intervals come from the reference.
pub fn intervals() -> String {
    let mut s = Sheet::new([840, 360], "A solid is a rule on intervals");
    let ball = |x: f64, radius: f64| Sphere { center: DVec3::new(x, 0.0, 0.0), radius };
    let (a, b, cut) = (ball(3.0, 1.15), ball(4.1, 0.75), 2.2);
    let half_space = Solid::HalfSpace { normal: DVec3::NEG_X, offset: -cut };
    let carved = Solid::difference(Solid::Ball(a), Solid::Ball(b));
    let solid = Solid::Intersection(vec![carved, half_space.clone()]);
    let length = 6.6;
    let origin = DVec3::new(0.0, 0.35, 0.0);
    let ray = Ray { origin, direction: DVec3::X, tmin: 0.0, tmax: length };
    let (left, middle, scale) = (40.0, 150.0, 82.0);
    let place = |x: f64, y: f64| [left + scale * x, middle - scale * y];
    let room = [place(cut, 1.2), place(6.5, 1.2), place(6.5, -1.2), place(cut, -1.2)];
    s.polygon(&room, GREEN, "none");
    s.circle(place(a.center.x, 0.0), scale * a.radius, YOURS, BROWN);
    s.circle(place(b.center.x, 0.0), scale * b.radius, WHITE, BROWN);
    s.arrow(&[place(0.0, origin.y), place(length, origin.y)]);
    s.dot(place(0.0, origin.y), 5.0, LINE);
    s.note(place(5.4, -1.0), Start, "half-space");
    s.title(place(2.6, -0.5), Middle, "A");
    s.title(place(4.3, -0.3), Middle, "B");
    let rows = [
        ("in A", Solid::Ball(a), YOURS),
        ("in B", Solid::Ball(b), WHITE),
        ("in the half-space", half_space, GREEN),
        ("in A, not in B, in the half-space", solid, BROWN),
    ];
    for (row, (name, solid, fill)) in rows.into_iter().enumerate() {
        let top = 258.0 + 24.0 * row as f64;
        s.line(&[[left, top + 9.0], [left + length * scale, top + 9.0]], FAINT, 1.0);
        for [from, to] in solid.intervals(&ray) {
            let (from, to) = (from.max(0.0), to.min(length));
            s.card([left + scale * from, top], [scale * (to - from), 18.0], fill, "", &[]);
        }
        s.say([596.0, top + 13.0], Start, name);
    }
    s.svg()
}

/// A swept sphere in 2D: its balls, the circles where body and caps meet, its normal and that of its axis.
pub fn swept() -> String {
    let mut s = Sheet::new([840, 330], "A swept sphere");
    let (a, b, r, q) = ([170.0, 178.0], [470.0, 178.0], 96.0, 34.0);
    let along = (b[0] - a[0], q - r);
    // The body touches each ball where the normal is inclined by δ/|u|.
    let lean: f64 = -along.1 / along.0;
    let cosine = (1.0 - lean * lean).sqrt();
    let ball = |part: f64| ([a[0] + part * along.0, a[1]], r + part * along.1);
    let edge = |part: f64, side: f64| {
        let (center, radius) = ball(part);
        [center[0] + radius * lean, center[1] - side * radius * cosine]
    };
    s.circle(a, r, YOURS, LINE);
    s.circle(b, q, YOURS, LINE);
    let corners = [edge(0.0, 1.0), edge(1.0, 1.0), edge(1.0, -1.0), edge(0.0, -1.0)];
    s.polygon(&corners, YOURS, "none");
    for side in [1.0, -1.0] {
        s.line(&[edge(0.0, side), edge(1.0, side)], LINE, 1.5);
    }
    for part in [0.25, 0.5, 0.75] {
        let (center, radius) = ball(part);
        s.circle(center, radius, "none", FAINT);
    }
    s.line(&[a, b], BROWN, 1.5);
    for part in [0.0, 1.0] {
        s.dashes(&[edge(part, 1.0), edge(part, -1.0)], BROWN, 1.5);
    }
    s.dot(a, 4.0, BROWN);
    s.dot(b, 4.0, BROWN);
    s.note([a[0] - 14.0, a[1] + 20.0], Middle, "a");
    s.note([b[0] + 16.0, b[1] + 18.0], Middle, "b");
    let hit = edge(0.5, 1.0);
    s.arrow(&[hit, [hit[0] + 74.0 * lean, hit[1] - 74.0 * cosine]]);
    s.dashed_arrow(&[hit, [hit[0], hit[1] - 74.0]]);
    s.dot(hit, 5.0, LINE);
    s.note([hit[0] + 24.0, hit[1] - 62.0], Start, "normal of the surface");
    s.note([hit[0] - 8.0, hit[1] - 62.0], Anchor::End, "of the axis: wrong");
    s.note([a[0] - 62.0, a[1] - 22.0], Middle, "cap");
    s.note([a[0] + 0.42 * along.0, a[1] + 34.0], Middle, "body");
    let lines = [
        "The balls from a to b fill the shape.",
        "Each touches the body along a circle,",
        "and the normal there goes through the",
        "ball's centre. The body begins and ends",
        "at the dashed circles; beyond them are",
        "the caps, parts of the two end spheres.",
    ];
    for (row, line) in lines.into_iter().enumerate() {
        s.say([556.0, 118.0 + 21.0 * row as f64], Start, line);
    }
    s.svg()
}
