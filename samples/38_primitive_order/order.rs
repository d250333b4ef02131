//! Orders in which boxes may be handed to a build.

use common::gpu::order::{self, Bounds};
use glam::Vec3;

common::shader_enum! {
    /// The rule that orders the boxes.
    pub enum Order { Given, Chance, AlongX = "along x", Morton = "Morton", Hilbert = "Hilbert", Halves }
}

/// Binary digits of a coordinate that the curves look at: a grid of 1024 cells along each axis.
const DIGITS: u32 = 10;

impl Order {
    /// The boxes' numbers in this order: the first place of the build holds box `order[0]`. Boxes that
    /// nothing tells apart stay as they are, so that the result is the same everywhere.
    pub fn of(self, bounds: &[Bounds]) -> Vec<u32> {
        let mut order: Vec<u32> = (0..bounds.len() as u32).collect();
        let grid = Grid::around(bounds);
        let cell = |i: u32| grid.cell(middle(bounds[i as usize]));
        match self {
            Order::Given => {}
            Order::Chance => order.sort_by_key(|&i| shuffled(i)),
            Order::AlongX => order.sort_by_key(|&i| cell(i)[0]),
            Order::Morton => order.sort_by_cached_key(|&i| morton(cell(i))),
            Order::Hilbert => order.sort_by_cached_key(|&i| hilbert(cell(i))),
            // The order of all other chapters.
            Order::Halves => order = order::kd_median(bounds),
        }
        order
    }
}

fn middle((low, high): Bounds) -> Vec3 {
    low * 0.5 + high * 0.5
}

/// The hash "lowbias32" of a number: it gives no two numbers the same one.
fn shuffled(i: u32) -> u32 {
    let i = (i ^ i >> 16).wrapping_mul(0x7feb_352d);
    let i = (i ^ i >> 15).wrapping_mul(0x846c_a68b);
    i ^ i >> 16
}

/// A cube of cells around the middles of all boxes.
struct Grid {
    low: Vec3,
    /// Cells a unit of length; the same along all axes, lest a curve's cells be long and thin.
    density: f32,
}

impl Grid {
    fn around(bounds: &[Bounds]) -> Self {
        let (low, high) = bounds
            .iter()
            .map(|&bounds| middle(bounds))
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), middle| {
                (low.min(middle), high.max(middle))
            });
        let side = (high - low).max_element();
        Self { low, density: if side > 0.0 { (1 << DIGITS) as f32 / side } else { 0.0 } }
    }

    fn cell(&self, point: Vec3) -> [u32; 3] {
        ((point - self.low) * self.density).to_array().map(|x| (x as u32).min((1 << DIGITS) - 1))
    }
}

/// The digits of three numbers by turns, the highest first: which eighth of the cube, which eighth of
/// that, and so on (Morton 1966).
fn morton(cell: [u32; 3]) -> u32 {
    (0..DIGITS)
        .rev()
        .fold(0, |code, digit| cell.into_iter().fold(code, |code, x| code << 1 | x >> digit & 1))
}

/// The distance of a cell along Hilbert's curve. It visits eighths as Morton's does, but turns and mirrors each, so
/// that it leaves one where the next begins (Skilling 2004).
fn hilbert(mut cell: [u32; 3]) -> u32 {
    for digit in (1..DIGITS).rev() {
        let below = (1 << digit) - 1;
        for axis in 0..3 {
            if cell[axis] >> digit & 1 == 1 {
                cell[0] ^= below;
            } else {
                let differ = (cell[0] ^ cell[axis]) & below;
                cell[0] ^= differ;
                cell[axis] ^= differ;
            }
        }
    }
    // By now a step along the curve flips one digit: a Gray code, whose number is the way.
    cell[1] ^= cell[0];
    cell[2] ^= cell[1];
    let flips = (1..DIGITS).filter(|digit| cell[2] >> digit & 1 == 1);
    let flipped = flips.fold(0, |flipped, digit| flipped ^ ((1 << digit) - 1));
    morton(cell.map(|x| x ^ flipped))
}
