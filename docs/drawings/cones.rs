//! A ray's cone: what it cuts from a surface, and what is read of the texture there.

use glam::DVec2;

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
    // As the shader takes it: a cylinder as wide as the cone at the hit.
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
