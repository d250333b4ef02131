//! Lamps as seen from a point, and the balance of two ways to sample them.

use glam::DVec2;

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, BROWN, GREEN, LEAF, LINE, Point, RED, SEA, SOFT, Sheet, WHITE, YOURS};

fn point(p: DVec2) -> Point {
    p.to_array()
}

/// Points on an arc around `middle`.
fn arc(middle: DVec2, radius: f64, from: f64, to: f64) -> Vec<Point> {
    let at = |i: i32| DVec2::from_angle(from + (to - from) * f64::from(i) / 24.0);
    (0..=24).map(|i| point(middle + radius * at(i))).collect()
}

/// A sphere's cone; a panel by area and by solid angle; and the balance of two densities.
pub fn solid_angles() -> String {
    let mut s = Sheet::new([840, 330], "From a point, a lamp is a solid angle");
    cone(&mut s);
    panel(&mut s);
    balance(&mut s);
    s.svg()
}

fn cone(s: &mut Sheet) {
    let (from, center, radius) = (DVec2::new(60.0, 250.0), DVec2::new(196.0, 122.0), 50.0);
    let to = center - from;
    let (axis, half) = (to.to_angle(), (radius / to.length()).asin());
    let reach = (to.length_squared() - radius * radius).sqrt();
    let rims = [-half, half].map(|turn| from + reach * DVec2::from_angle(axis + turn));
    let mut wedge = arc(from, 64.0, axis - half, axis + half);
    wedge.push(point(from));
    s.circle(point(center), radius, YOURS, BROWN);
    s.polygon(&wedge, BLUE, "none");
    for rim in rims {
        s.line(&[point(from), point(rim)], LINE, 1.4);
        s.dashes(&[point(rim), point(center)], LINE, 1.2);
    }
    s.dashes(&[point(from), point(center)], LINE, 1.2);
    s.line(&arc(from, 64.0, axis - half, axis + half), BROWN, 3.0);
    s.line(&arc(from, 38.0, axis, axis + half), SOFT, 1.2);
    s.dot(point(from), 4.5, LINE);
    s.dot(point(center), 3.0, BROWN);
    s.say([96.0, 224.0], Start, "α");
    s.say([132.0, 168.0], Start, "d");
    s.say([222.0, 160.0], Start, "r");
    s.title([24.0, 292.0], Start, "A sphere fills a cone.");
    s.note([24.0, 311.0], Start, "sin α = r/d; its area is 2π(1 − cos α)");
}

fn panel(s: &mut Sheet) {
    let from = DVec2::new(340.0, 250.0);
    let (low, high) = (DVec2::new(390.0, 250.0), DVec2::new(390.0, 66.0));
    s.line(&[[300.0, 250.0], [520.0, 250.0]], LINE, 1.6);
    s.line(&[point(low), point(high)], BROWN, 6.0);
    let angles = [low, high].map(|end| (end - from).to_angle());
    for i in 0..8 {
        let part = (f64::from(i) + 0.5) / 8.0;
        let turned = DVec2::from_angle(angles[0] + part * (angles[1] - angles[0]));
        // The point where a ray in this direction crosses the panel's line.
        let edge = high - low;
        let t = edge.perp_dot(low - from) / edge.perp_dot(turned);
        s.line(&[point(from), point(from + t * turned)], LINE, 1.0);
        let across = -edge.perp().normalize() * 12.0;
        let by_area = low + part * edge;
        s.dot(point(by_area + across), 3.4, RED);
        s.dot(point(by_area + across), 1.6, WHITE);
    }
    s.dot(point(from), 4.5, LINE);
    s.title([300.0, 292.0], Start, "A panel, seen from close by.");
    s.note([300.0, 311.0], Start, "Rings: even in area. Rays: even in angle.");
    s.note([416.0, 110.0], Start, "by area, most points");
    s.note([416.0, 128.0], Start, "are far from where");
    s.note([416.0, 146.0], Start, "the light comes from");
}

fn balance(s: &mut Sheet) {
    let (left, bottom, width, height) = (590.0, 250.0, 220.0, 150.0);
    // A cosine over directions, and a lamp's density within its cone.
    let by_surface = |x: f64| 0.55 * (std::f64::consts::PI * (x - 0.5)).cos();
    let by_lamp = |x: f64| if (0.52..0.78).contains(&x) { 0.85 } else { 0.0 };
    let at = |x: f64, y: f64| [left + width * x, bottom - height * y];
    let xs = || (0..=100).map(|i| f64::from(i) / 100.0);
    let within: Vec<f64> = xs().filter(|x| by_lamp(*x) > 0.0).collect();
    let (first, last) = (within[0], within[within.len() - 1]);
    // All light is in the lamp's column; each way is weighted by its share of the density.
    let part = |x: f64| by_lamp(x) * by_surface(x) / (by_surface(x) + by_lamp(x));
    let shared: Vec<Point> = within.iter().map(|&x| at(x, part(x))).collect();
    let lower = [&[at(first, 0.0)], &shared[..], &[at(last, 0.0)]].concat();
    let upper = [&[at(first, 0.85)], &shared[..], &[at(last, 0.85)]].concat();
    s.polygon(&lower, GREEN, "none");
    s.polygon(&upper, BLUE, "none");
    let surface: Vec<Point> = xs().map(|x| at(x, by_surface(x))).collect();
    s.line(&surface, LEAF, 2.2);
    s.line(
        &[
            at(0.0, 0.0),
            at(first, 0.0),
            at(first, 0.85),
            at(last, 0.85),
            at(last, 0.0),
            at(1.0, 0.0),
        ],
        SEA,
        2.2,
    );
    s.line(&[at(0.0, 0.0), at(1.0, 0.0)], LINE, 1.2);
    s.note(at(0.2, 0.6), Middle, "p of the surface");
    s.say(at(0.65, 0.6), Middle, "light");
    s.say(at(0.65, 0.12), Middle, "BSDF");
    s.note(at(0.65, 0.91), Middle, "p of the lamp");
    s.note(at(0.5, -0.11), Middle, "directions");
    s.title([left, 292.0], Start, "Two densities, one light.");
    s.note([left, 311.0], Start, "divided as the densities are");
}
