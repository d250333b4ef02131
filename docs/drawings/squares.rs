//! The points of a pixel: how even they are, and how they are scrambled.

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, BROWN, LINE, Point, Sheet, WHITE, YOURS};

/// The number of points, and the binary digits of their coordinates.
const COUNT: u32 = 16;
const DIGITS: u32 = 4;

/// The first points of Sobol', in sixteenths.
fn sobol() -> Vec<[u32; 2]> {
    let mirrored = |bits: u32| bits.reverse_bits() >> (32 - DIGITS);
    let second = |i: u32| {
        // Digit j is the parity of the bits k of i for which the binomial coefficient of k over j is odd.
        let digit =
            |j: u32| (0..DIGITS).filter(|&k| i >> k & 1 == 1 && j & !k == 0).count() as u32 % 2;
        (0..DIGITS).fold(0, |y, j| y | digit(j) << (DIGITS - 1 - j))
    };
    (0..COUNT).map(|i| [mirrored(i), second(i)]).collect()
}

/// A square from its lower left corner, and its contents.
struct Square {
    corner: Point,
    side: f64,
}

impl Square {
    /// A place, each coordinate in [0, 1].
    fn at(&self, x: f64, y: f64) -> Point {
        [self.corner[0] + x * self.side, self.corner[1] - y * self.side]
    }

    fn area(&self, s: &mut Sheet, [left, right]: [f64; 2], fill: &str) {
        let corners = [(left, 0.0), (right, 0.0), (right, 1.0), (left, 1.0)];
        s.polygon(&corners.map(|(x, y)| self.at(x, y)), fill, LINE);
    }

    fn grid(&self, s: &mut Sheet, columns: u32, rows: u32, color: &str) {
        for column in 1..columns {
            let x = f64::from(column) / f64::from(columns);
            s.line(&[self.at(x, 0.0), self.at(x, 1.0)], color, 1.0);
        }
        for row in 1..rows {
            let y = f64::from(row) / f64::from(rows);
            s.line(&[self.at(0.0, y), self.at(1.0, y)], color, 1.0);
        }
    }

    fn dot(&self, s: &mut Sheet, [x, y]: [u32; 2], color: &str) {
        let middle = |digit: u32| (f64::from(digit) + 0.5) / f64::from(COUNT);
        s.dot(self.at(middle(x), middle(y)), 4.0, color);
    }
}

/// The same points in five grids with the same number of boxes.
pub fn boxes() -> String {
    let mut s =
        Sheet::new([840, 232], "The first 16 points of Sobol': one in each box, whatever the grid");
    for (k, columns) in [16, 8, 4, 2, 1].into_iter().enumerate() {
        let rows = COUNT / columns;
        let square = Square { corner: [24.0 + 163.0 * k as f64, 196.0], side: 140.0 };
        square.area(&mut s, [0.0, 1.0], WHITE);
        square.grid(&mut s, columns, rows, LINE);
        for point in sobol() {
            square.dot(&mut s, point, BROWN);
        }
        s.note(square.at(0.5, -0.13), Middle, &format!("{columns} × {rows}"));
    }
    s.svg()
}

/// One coin per part of the square: one for the whole, then one for each half, each quarter, each eighth.
const COLUMN_COINS: u32 = 0b100_1011_0100_1101;
const ROW_COINS: u32 = 0b011_0110_0010_1011;

/// A coordinate whose first digits are flipped, each by the coin of the digits before it.
fn owen(x: u32, coins: u32, digits: u32) -> u32 {
    (0..digits).fold(x, |flipped, digit| {
        let before = x >> (DIGITS - digit);
        let coin = coins >> ((1 << digit) - 1 + before) & 1;
        flipped ^ coin << (DIGITS - 1 - digit)
    })
}

/// Owen's scrambling, digit by digit.
pub fn scrambling() -> String {
    let mut s = Sheet::new([840, 300], "Owen scrambling: a coin for each part of the square");
    // The number of flipped digits of x and of y, and the place of the coloured parts after each step.
    let steps = [
        (
            "as they come",
            "The left half is coloured,",
            "and a quarter of the right.",
            [0, 0],
            [0.0, 0.5],
        ),
        ("one coin: heads", "The halves change places.", "", [1, 0], [0.5, 0.0]),
        (
            "two coins: tails, heads",
            "So do the quarters of one half;",
            "those of the other do not.",
            [2, 0],
            [0.5, 0.25],
        ),
        (
            "so on, then the rows",
            "Each box still has",
            "its one point.",
            [DIGITS, DIGITS],
            [0.5, 0.25],
        ),
    ];
    for (k, (title, first, second, [columns, rows], [half, quarter])) in
        steps.into_iter().enumerate()
    {
        let square = Square { corner: [24.0 + 212.0 * k as f64, 240.0], side: 156.0 };
        s.title([square.corner[0], 70.0], Start, title);
        square.area(&mut s, [0.0, 1.0], WHITE);
        square.area(&mut s, [half, half + 0.5], YOURS);
        square.area(&mut s, [quarter, quarter + 0.25], BLUE);
        square.grid(&mut s, 4, 4, LINE);
        for [x, y] in sobol() {
            square.dot(&mut s, [owen(x, COLUMN_COINS, columns), owen(y, ROW_COINS, rows)], BROWN);
        }
        s.note([square.corner[0], 262.0], Start, first);
        s.note([square.corner[0], 280.0], Start, second);
    }
    s.svg()
}
