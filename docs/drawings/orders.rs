//! Points in four orders, and the quarters of each list.

use crate::sheet::Anchor::Middle;
use crate::sheet::{BROWN, FAINT, LEAF, LINE, Point, RED, SEA, Sheet};

/// The number of points.
const COUNT: u32 = 48;
/// The binary digits of a coordinate used by the curves.
const DIGITS: u32 = 5;

/// Random points of the square [0, 1], in the order in which they are generated.
fn points() -> Vec<[f64; 2]> {
    let mut state = 7u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    (0..COUNT).map(|_| [next(), next()]).collect()
}

fn cell(point: &[f64; 2]) -> [u32; 2] {
    point.map(|x| (x * f64::from(1 << DIGITS)) as u32)
}

/// Interleaves the digits, the highest first.
fn morton([x, y]: [u32; 2]) -> u32 {
    (0..DIGITS).rev().fold(0, |code, digit| code << 2 | (x >> digit & 1) << 1 | y >> digit & 1)
}

/// The position along Hilbert's curve.
fn hilbert([mut x, mut y]: [u32; 2]) -> u32 {
    (0..DIGITS).rev().fold(0, |way, digit| {
        let [right, up] = [x, y].map(|x| x >> digit & 1);
        let last = (1 << digit) - 1;
        (x, y) = (x & last, y & last);
        if up == 0 {
            if right == 1 {
                (x, y) = (last - x, last - y);
            }
            (x, y) = (y, x);
        }
        (way << 2) | ((3 * right) ^ up)
    })
}

/// The same points in four orders. The tree's second level has four boxes, one for each quarter of the list.
pub fn quarters() -> String {
    let mut s = Sheet::new(
        [840, 282],
        "The same 48 points in four orders: the boxes around the four quarters of each list",
    );
    let mut by_x = points();
    by_x.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let by = |code: fn([u32; 2]) -> u32| {
        let mut points = points();
        points.sort_by_key(|point| code(cell(point)));
        points
    };
    let orders = [
        ("by chance", points()),
        ("along x", by_x),
        ("Morton", by(morton)),
        ("Hilbert", by(hilbert)),
    ];
    for (k, (name, list)) in orders.into_iter().enumerate() {
        let corner = [28.0 + 204.0 * k as f64, 64.0];
        let side = 172.0;
        let place =
            |[x, y]: [f64; 2]| -> Point { [corner[0] + side * x, corner[1] + side * (1.0 - y)] };
        let way: Vec<Point> = list.iter().map(|&point| place(point)).collect();
        s.line(&way, FAINT, 1.2);
        for (quarter, color) in way.chunks(way.len() / 4).zip([RED, LEAF, SEA, BROWN]) {
            let bound = |axis: usize, pick: fn(f64, f64) -> f64, start| {
                quarter.iter().map(|point| point[axis]).fold(start, pick)
            };
            let [left, top] = [0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY) - 4.0);
            let [right, bottom] = [0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY) + 4.0);
            let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
            s.line(&corners, color, 1.8);
            for &point in quarter {
                s.dot(point, 3.2, color);
            }
        }
        s.title([corner[0] + side / 2.0, 266.0], Middle, name);
    }
    s.line(&[[24.0, 48.0], [816.0, 48.0]], LINE, 0.6);
    s.svg()
}
