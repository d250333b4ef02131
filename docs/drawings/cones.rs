//! A ray's cone: its ellipse on a surface, and the texture lookups there.

use glam::DVec2;
use std::f64::consts::FRAC_PI_2;

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BROWN, FAINT, LINE, Point, RED, SEA, Sheet, WHITE, YOURS};

fn point(p: DVec2) -> Point {
    p.to_array()
}

/// Left the cone from the side; right its ellipse on the texture, with one wide lookup and a row of narrow ones.
pub fn ellipse() -> String {
    let mut s = Sheet::new([840, 330], "A cone, the ellipse that it cuts, and what is read of it");
    from_the_side(&mut s);
    on_the_texture(&mut s);
    s.svg()
}

fn from_the_side(s: &mut Sheet) {
    let (eye, floor) = (DVec2::new(40.0, 110.0), 236.0);
    let (slope, half) = (0.42_f64, 0.085);
    let towards = |turn: f64| DVec2::from_angle(slope + turn);
    let on_floor = |turn: f64| {
        let along = towards(turn);
        eye + along * ((floor - eye.y) / along.y)
    };
    s.line(&[[24.0, floor], [470.0, floor]], LINE, 3.0);
    let hit = on_floor(0.0);
    let width = 2.0 * half * hit.distance(eye);
    let across = towards(0.0).perp() * (width / 2.0);
    // As in the shader: a cylinder as wide as the cone at the hit.
    let long = width / slope.sin();
    let ends = [hit - DVec2::X * (long / 2.0), hit + DVec2::X * (long / 2.0)];
    s.polygon(&[eye, hit + across, hit - across].map(point), YOURS, BROWN);
    s.dashes(&[eye, hit].map(point), LINE, 1.4);
    s.line(&[hit + across, hit - across].map(point), SEA, 3.0);
    s.line(&ends.map(point), RED, 6.0);
    s.dot(point(eye), 5.0, LINE);
    s.note([eye.x, eye.y - 12.0], Middle, "eye");
    s.say([hit.x - 118.0, hit.y - 96.0], Start, "the cone's width, w = spread · t");
    s.line(&[[hit.x - 20.0, hit.y - 90.0], [hit.x + 4.0, hit.y - 30.0]], LINE, 1.0);
    s.say([hit.x, floor + 50.0], Middle, "along the surface: w / cosine");
    s.note([24.0, 72.0], Start, "from the side");
}

fn on_the_texture(s: &mut Sheet) {
    let (left, top, texel, columns, rows) = (528.0, 92.0, 18.0, 16, 9);
    s.note([left, 72.0], Start, "on the texture, in texels of level 0");
    for k in 0..=columns {
        let x = left + texel * f64::from(k);
        s.line(&[[x, top], [x, top + texel * f64::from(rows)]], FAINT, 1.0);
    }
    for k in 0..=rows {
        let y = top + texel * f64::from(k);
        s.line(&[[left, y], [left + texel * f64::from(columns), y]], FAINT, 1.0);
    }
    let middle = DVec2::new(left + 8.0 * texel, top + 4.5 * texel);
    let along = DVec2::from_angle(-0.3);
    let (long, wide) = (6.4 * texel, 1.6 * texel);
    let rim = |i: i32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 48.0).sin_cos();
        point(middle + along * (long * cos) + along.perp() * (wide * sin))
    };
    let rim: Vec<Point> = (0..48).map(rim).collect();
    s.polygon(&rim, YOURS, BROWN);
    for k in 0..4 {
        let at = middle + along * (2.0 * long * ((f64::from(k) + 0.5) / 4.0 - 0.5));
        s.circle(point(at), wide, WHITE, RED);
        s.dot(point(at), 3.0, RED);
    }
    s.say([left, 284.0], Start, "four lookups along the longer axis,");
    s.say([left, 302.0], Start, "each as wide as the shorter one: level 1.7");
}

/// A cone at a convex and at a concave mirror, next to its image in a flat one. Its rays are mirrored one by
/// one.
pub fn bent() -> String {
    let mut s = Sheet::new([840, 330], "A cone at a mirror that bulges, and at one that is hollow");
    for (left, radius, title) in [
        (24.0, 150.0, "It bulges: the cone spreads more"),
        (440.0, -150.0, "It is hollow: a focus, then it spreads"),
    ] {
        s.title([left, 62.0], Start, title);
        at_mirror(&mut s, DVec2::new(left + 150.0, 240.0), radius);
    }
    s.svg()
}

/// The mirror's middle is at `hit`, and faces up; `radius` is negative for a concave one.
fn at_mirror(s: &mut Sheet, hit: DVec2, radius: f64) {
    let center = hit + DVec2::Y * radius;
    let arc = |i: i32| {
        let turn = -FRAC_PI_2 * radius.signum() + f64::from(i) * 4.0 / radius;
        point(center + radius.abs() * DVec2::from_angle(turn))
    };
    s.line(&(-24..=24).map(arc).collect::<Vec<_>>(), LINE, 4.0);
    let (slope, half, far) = (0.85, 0.055, 190.0);
    let eye = hit - DVec2::from_angle(slope) * 165.0;
    // The drawing ends at right angles to the axis of the mirrored cone.
    let onwards = DVec2::from_angle(-slope);
    // The place where a ray is mirrored, at the circle or at its tangent, and its end.
    let traced = |turn: f64, is_flat: bool| {
        let along = DVec2::from_angle(slope + turn);
        let to_center = eye - center;
        let b = along.dot(to_center);
        let root = (b * b - to_center.length_squared() + radius * radius).sqrt();
        let at = eye
            + along * if is_flat { (hit.y - eye.y) / along.y } else { -b - radius.signum() * root };
        let normal = if is_flat { DVec2::NEG_Y } else { (at - center) / radius };
        let along = along - 2.0 * along.dot(normal) * normal;
        [at, at + along * ((far - (at - hit).dot(onwards)) / along.dot(onwards))]
    };
    let [low, high] = [-half, half].map(|turn| traced(turn, false));
    s.polygon(&[eye, low[0], high[0]].map(point), YOURS, "none");
    s.polygon(&[low[0], low[1], high[1], high[0]].map(point), YOURS, "none");
    for [from, to] in [-half, half].map(|turn| traced(turn, true)) {
        s.dashes(&[from, to].map(point), RED, 1.4);
    }
    for [at, end] in [low, high] {
        s.line(&[eye, at, end].map(point), BROWN, 1.5);
    }
    s.dot(point(eye), 5.0, LINE);
    s.note([eye.x - 10.0, eye.y - 10.0], Middle, "eye");
    s.note([hit.x - 18.0, hit.y - 18.0], Middle, "w");
    s.note([hit.x, hit.y + 48.0], Middle, "dashed: as from a flat mirror");
    if radius > 0.0 {
        return s.note([hit.x + 150.0, hit.y - 60.0], Start, "spread s + 2kw");
    }
    let [first, second] = [low, high].map(|[at, end]| (end - at).normalize());
    let focus = low[0] + first * ((high[0] - low[0]).perp_dot(second) / first.perp_dot(second));
    s.dot(point(focus), 4.0, RED);
    s.say([focus.x + 14.0, focus.y + 18.0], Start, "focus: the width is 0");
    s.say([focus.x - 52.0, focus.y - 62.0], Middle, "beyond it, negative");
}
