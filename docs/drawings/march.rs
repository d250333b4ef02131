//! A ray that marches over a landscape.

use reference::heightfield::Heightfield;

use crate::sheet::Anchor::Start;
use crate::sheet::{BROWN, GREEN, LINE, Point, Sheet};

/// A ray over the land, in 2D: its height at x = 0, and its slope.
const RAY: [f64; 2] = [0.58, -0.09];

/// The position after each step of a march, as t. A step is `factor` times the height.
fn march(land: &Heightfield, factor: f64) -> Vec<f64> {
    let mut places = vec![0.0];
    while places.len() < 60 {
        let t = places[places.len() - 1];
        let [x, y] = at(t);
        let h = y - land.height(x, 0.0).0;
        if h.abs() < 0.0015 * t || x > 7.9 {
            break;
        }
        places.push(t + factor * h);
    }
    places
}

/// A point of the ray; its direction has length 1.
fn at(t: f64) -> [f64; 2] {
    let along = t / RAY[1].hypot(1.0);
    [along, RAY[0] + RAY[1] * along]
}

/// Steps of 2·h, and the longest safe steps.
pub fn steps() -> String {
    let mut s = Sheet::new([840, 430], "How far may a step go?");
    let land = Heightfield {
        k: 1.0,
        a: 0.2,
        fx: 0.17,
        fz: 0.0,
        b: 0.3,
        gx: 0.65,
        gz: 0.0,
        lipschitz: 2.0,
    };
    let slope = |x: f64| land.height(x, 0.0).1[0].abs();
    let steepest = (0..4000).map(|k| slope(f64::from(k) * 2e-3)).fold(0.0, f64::max);
    // The speed at which the ray approaches ground of the steepest slope, per unit of t.
    let falling = (steepest - RAY[1]) / RAY[1].hypot(1.0);
    let (left, scale) = (40.0, 95.0);
    let marches = [("Steps of 2·h", 2.0), ("Steps of h / (L·|d_xz| − d_y)", 1.0 / falling)];
    let [long, safe] = marches.map(|(_, factor)| march(&land, factor));
    let (long_end, safe_end) = (at(long[long.len() - 1])[0], at(safe[safe.len() - 1])[0]);
    assert!(safe_end + 1.0 < long_end, "the long steps should miss a hill");
    for ((title, _), (places, base)) in marches.into_iter().zip([(long, 170.0), (safe, 356.0)]) {
        let place = |[x, y]: [f64; 2]| -> Point { [left + scale * x, base - scale * y] };
        let ground = |k: i32| [f64::from(k) * 0.02, land.height(f64::from(k) * 0.02, 0.0).0];
        let mut outline: Vec<Point> = (0..=400).map(|k| place(ground(k))).collect();
        outline.extend([[left + 8.0 * scale, base + 62.0], [left, base + 62.0]]);
        s.polygon(&outline, GREEN, LINE);
        s.line(&[place(at(0.0)), place(at(8.0))], LINE, 1.0);
        for t in &places {
            s.dot(place(at(*t)), 3.2, BROWN);
        }
        s.title([left, base - 104.0], Start, title);
        let missed = at(places[places.len() - 1])[0] > safe_end + 1.0;
        let told = if missed { ": over the first hill that it should have met" } else { "" };
        s.note([left + 280.0, base - 104.0], Start, &format!("{} steps{told}", places.len() - 1));
    }
    s.svg()
}
