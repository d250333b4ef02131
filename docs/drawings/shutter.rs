//! The shutter's time: the times of samples, and the position of a triangle at each.

use glam::DVec2;

use crate::sheet::Anchor::{End, Middle, Start};
use crate::sheet::{BROWN, FAINT, LEAF, LINE, Point, RED, SEA, Sheet, WHITE, YOURS};

/// The number of samples per pixel, and of moments.
const COUNT: u32 = 8;
/// The game's frame for which the random numbers are drawn.
const FRAME: u32 = 934;
/// The dimension of the random numbers: `DIMENSION_TIME` of the chapter.
const DIMENSION: u32 = 2;

/// A time of the shutter, from the number of a sample and a random number.
type TimeOf = dyn Fn(u32, f64) -> f64;

/// The number that `random` of `common/random.glsl` returns for a sample of a pixel: 24 bits of a hash.
fn random([x, y]: [u32; 2], sample: u32) -> f64 {
    let mut v = [x | y << 16, sample, FRAME, DIMENSION]
        .map(|x| x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let mut round = |shift: u32| {
        for [to, a, b] in [[0, 1, 3], [1, 2, 0], [2, 0, 1], [3, 1, 2]] {
            v[to] = v[to].wrapping_add(v[a].wrapping_mul(v[b]));
        }
        v = v.map(|x| if shift > 0 { x ^ x >> shift } else { x });
    };
    round(16);
    round(0);
    f64::from(v[0] >> 8) / f64::from(1 << 24)
}

/// The longest part of the time from 0 to 1 without a sample.
fn longest(times: &[f64]) -> [f64; 2] {
    let mut ends: Vec<f64> = times.iter().copied().chain([0.0, 1.0]).collect();
    ends.sort_by(f64::total_cmp);
    let gaps = ends.windows(2).map(|pair| [pair[0], pair[1]]);
    gaps.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0]))).expect("a gap")
}

/// The times of eight samples of four pixels, at random and in strata, computed as in the chapter's shader.
pub fn times() -> String {
    let mut s = Sheet::new([840, 262], "When eight samples of a pixel look, in four pixels");
    let strata = |i: u32, u: f64| (f64::from(i) + u) / f64::from(COUNT);
    let random_times = |_: u32, u: f64| u;
    let panels: [(&str, &TimeOf, f64); 2] =
        [("random", &random_times, 40.0), ("in strata", &strata, 448.0)];
    let (top, row, wide) = (88.0, 32.0, 352.0);
    for (name, time, left) in panels {
        s.title([left, 66.0], Start, name);
        if name == "in strata" {
            for k in 0..=COUNT {
                let x = left + wide * f64::from(k) / f64::from(COUNT);
                s.line(&[[x, top - 12.0], [x, top + 3.0 * row + 12.0]], FAINT, 1.2);
            }
        }
        let mut most = 0.0_f64;
        for pixel in 0..4 {
            let y = top + row * f64::from(pixel);
            let at = |time: f64| -> Point { [left + wide * time, y] };
            let times: Vec<f64> =
                (0..COUNT).map(|i| time(i, random([60 + pixel, 40], i))).collect();
            let [from, to] = longest(&times);
            most = most.max(to - from);
            s.line(&[at(0.0), at(1.0)], LINE, 1.2);
            s.line(&[at(from), at(to)], RED, 4.0);
            times.iter().for_each(|&time| s.dot(at(time), 5.0, SEA));
        }
        let below = top + 3.0 * row + 30.0;
        s.note([left, below], Start, "the shutter opens");
        s.note([left + wide, below], End, "and closes");
        let longest = format!("the longest time unseen: {most:.2} of the shutter's");
        s.say([left + wide / 2.0, below + 26.0], Middle, &longest);
    }
    s.svg()
}

/// A 2D triangle that moves and turns, and the time of the ray traced to it.
const CORNERS: [DVec2; 3] =
    [DVec2::new(-34.0, 30.0), DVec2::new(30.0, 26.0), DVec2::new(4.0, -46.0)];
const PLACES: [DVec2; 2] = [DVec2::new(76.0, 168.0), DVec2::new(292.0, 128.0)];
const TURN: f64 = 1.2;
const TIME: f64 = 0.62;

/// The corners relative to the triangle's position, by the normalized mean of two quaternions.
fn turned(time: f64) -> [DVec2; 3] {
    let half = TURN / 2.0;
    let angle = 2.0 * (time * half.sin()).atan2(1.0 - time + time * half.cos());
    CORNERS.map(|corner| DVec2::from_angle(angle).rotate(corner))
}

fn triangle(left: f64, time: f64) -> [Point; 3] {
    let place = PLACES[0].lerp(PLACES[1], time) + DVec2::X * left;
    turned(time).map(|corner| (place + corner).to_array())
}

/// The bounding box of its motion, computed as in `sweep.comp`.
fn swept(left: f64) -> [Point; 4] {
    let bulge = 0.5 * (TURN / 4.0).tan();
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for (from, to) in turned(0.0).into_iter().zip(turned(1.0)) {
        let more = DVec2::splat(bulge * from.distance(to));
        low = low.min(from.min(to) - more);
        high = high.max(from.max(to) + more);
    }
    let low = low + PLACES[0].min(PLACES[1]) + DVec2::X * left;
    let high = high + PLACES[0].max(PLACES[1]) + DVec2::X * left;
    [low.to_array(), [high.x, low.y], high.to_array(), [low.x, high.y]]
}

/// On the left a copy for each of eight moments, on the right the bounding box of the motion.
pub fn methods() -> String {
    let heading = format!("What a ray of time {TIME} meets, by two methods");
    let mut s = Sheet::new([840, 292], &heading);
    let (first, second) = (30.0, 446.0);
    s.title([first, 66.0], Start, "eight moments");
    s.title([second, 66.0], Start, "swept");
    let outline = |[a, b, c]: [Point; 3]| [a, b, c, a];

    let moment = (TIME * f64::from(COUNT)).floor();
    let at = |moment: f64| (moment + 0.5) / f64::from(COUNT);
    for other in (0..COUNT).map(f64::from).filter(|&other| other != moment) {
        s.line(&outline(triangle(first, at(other))), LINE, 1.2);
    }
    s.polygon(&triangle(first, at(moment)), YOURS, BROWN);
    s.dashes(&outline(triangle(first, TIME)), RED, 1.8);

    s.polygon(&swept(second), WHITE, LEAF);
    for end in [0.0, 1.0] {
        s.line(&outline(triangle(second, end)), LINE, 1.2);
    }
    s.polygon(&triangle(second, TIME), YOURS, BROWN);
    for [from, to] in [[0.0, TIME], [TIME, 1.0]] {
        for corner in 0..3 {
            let way = (0..=12).map(|i| from + (to - from) * f64::from(i) / 12.0);
            let way: Vec<Point> = way.map(|time| triangle(second, time)[corner]).collect();
            s.dashes(&way, LINE, 1.0);
        }
    }

    let rows = [
        (
            first,
            format!("Eight instances: the ray sees number {moment}, of time {:.4}.", at(moment)),
        ),
        (first, format!("Red: where the triangle is at {TIME}.")),
        (second, "One box around the whole way: the ray meets it, and".to_owned()),
        (second, format!("the intersection shader moves the triangle to {TIME}.")),
    ];
    for (k, (left, text)) in rows.into_iter().enumerate() {
        s.say([left, 250.0 + 20.0 * (k % 2) as f64], Start, &text);
    }
    s.svg()
}
