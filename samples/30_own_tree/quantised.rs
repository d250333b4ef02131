//! Nodes in 36 bytes instead of 64: corners in 8 bits, rounded outward.
//!
//! After Ylitie et al., "Efficient incoherent ray traversal on GPUs through compressed wide BVHs" (2017): a
//! node has a grid of its own, whose steps are powers of two.

use anyhow::{Result, ensure};
use common::glam::Vec3;

use crate::check::LEAF;
use crate::hull::Hull;
use crate::tree::{Bounds, Child, Node};

common::shader_struct! {
    /// A node whose boxes are on a grid: a coordinate is `origin + q * step`, q a whole number up to 255.
    /// 36 bytes.
    pub struct Quantised {
        /// The grid's corner.
        pub origin: Vec3,
        /// A byte an axis, x the lowest: the exponent of its step, as a 32-bit float has it. So shifted by 23
        /// it is the step. In the fourth, four bits a child, how many primitives it holds; 0 for a node.
        pub steps: u32,
        /// A word an axis, of four bytes, the lowest first: low of the first child, low of the second,
        /// high of the first, high of the second.
        pub boxes: [u32; 3],
        /// As [`Child::first`].
        pub first: [u32; 2],
    }
}

/// The largest number that steps may reach, so that no sum is infinite: 2^126.
const REACH: f32 = f32::from_bits((126 + 127) << 23);

/// The same nodes, in the same places, with boxes that hold those that they had.
///
/// They do so in 32-bit floats, too: whether a sum is rounded up, down, or to zero where it is subnormal.
///
/// # Errors
/// If a leaf holds more than [`LEAF`] primitives, or a box goes beyond 2^126.
pub fn quantised(nodes: &[Node]) -> Result<Vec<Quantised>> {
    nodes.iter().map(node).collect()
}

fn node(node: &Node) -> Result<Quantised> {
    let boxes = node.children.map(|child| (child.low, child.high));
    let around = boxes.iter().filter(|bounds| !is_empty(bounds));
    let around = around.fold(Hull::EMPTY, |hull, &bounds| hull.join(&bounds.into()));
    let (low, high) = match Bounds::from(around) {
        nothing if is_empty(&nothing) => (Vec3::ZERO, Vec3::ZERO),
        around => around,
    };
    ensure!(low.min_element() >= -REACH && high.max_element() <= REACH, "a box goes beyond 2^126");
    let mut found =
        Quantised { origin: low, steps: 0, boxes: [0; 3], first: node.children.map(|c| c.first) };
    for axis in 0..3 {
        let grid = Grid::around(low[axis], high[axis]);
        let [a, b] = boxes.map(|bounds| match bounds {
            nothing if is_empty(&nothing) => [255, 0],
            (low, high) => [grid.down(low[axis]), grid.up(high[axis])],
        });
        found.origin[axis] = grid.origin;
        found.steps |= grid.step.to_bits() >> 23 << (8 * axis);
        found.boxes[axis] = u32::from_le_bytes([a[0], b[0], a[1], b[1]]);
    }
    for (side, child) in node.children.iter().enumerate() {
        ensure!(child.count <= LEAF, "a leaf holds {} primitives, beyond {LEAF}", child.count);
        found.steps |= child.count << (24 + 4 * side);
    }
    Ok(found)
}

fn is_empty((low, high): &Bounds) -> bool {
    low.x > high.x
}

impl Quantised {
    /// The boxes, as a shader finds them.
    pub fn children(&self) -> [Child; 2] {
        let step = |axis: u32| f32::from_bits((self.steps >> (8 * axis) & 0xff) << 23);
        let steps = Vec3::from_array([0, 1, 2].map(step));
        let corner = |byte: usize| {
            let places = self.boxes.map(|word| f32::from(word.to_le_bytes()[byte]));
            self.origin + Vec3::from_array(places) * steps
        };
        [0, 1].map(|side| Child {
            low: corner(side),
            first: self.first[side],
            high: corner(side + 2),
            count: self.steps >> (24 + 4 * side) & 0xf,
        })
    }
}

/// A grid along one axis. A step is no shorter than the distance of floats at the far end, so that two places
/// of the grid are two numbers.
#[derive(Clone, Copy)]
struct Grid {
    origin: f32,
    step: f32,
}

impl Grid {
    fn around(low: f32, high: f32) -> Self {
        // A shader may read a subnormal number as 0.
        let origin = if !low.is_subnormal() {
            low
        } else if low > 0.0 {
            0.0
        } else {
            -f32::MIN_POSITIVE
        };
        let ulp = f32::EPSILON * origin.abs().max(high.abs());
        let exponent = |x: f32| x.max(f32::MIN_POSITIVE).to_bits() >> 23;
        // A power of two at or below what is needed, and then the first that suffices.
        let needed = ((high * 0.25 - origin * 0.25) / 64.0).max(ulp);
        let steps = (exponent(needed)..).map(|exponent| f32::from_bits(exponent << 23));
        let mut grids = steps.map(|step| Self { origin, step });
        grids.find(|grid| grid.is_at_least(255, high)).expect("the steps go beyond REACH")
    }

    /// Tests whether a place on the grid is never above a number, however its sum is rounded.
    fn is_at_most(self, q: u8, x: f32) -> bool {
        let (sum, rest) = self.exact(q);
        let lost = sum.abs() < f64::from(f32::MIN_POSITIVE) && x < 0.0;
        !lost && (sum < f64::from(x) || sum == f64::from(x) && rest <= 0.0)
    }

    /// Tests whether it is never below.
    fn is_at_least(self, q: u8, x: f32) -> bool {
        let (sum, rest) = self.exact(q);
        let lost = sum.abs() < f64::from(f32::MIN_POSITIVE) && x > 0.0;
        !lost && (sum > f64::from(x) || sum == f64::from(x) && rest >= 0.0)
    }

    /// `origin + q * step` as a sum in 64 bits and what it lacks: together exact (Knuth's two-sum).
    fn exact(self, q: u8) -> (f64, f64) {
        let (a, b) = (f64::from(self.origin), f64::from(q) * f64::from(self.step));
        let sum = a + b;
        let part = sum - a;
        (sum, (a - (sum - part)) + (b - part))
    }

    /// The last place that is never above a number. The origin is none.
    fn down(self, x: f32) -> u8 {
        (1..=self.near(x)).rev().find(|&q| self.is_at_most(q, x)).unwrap_or(0)
    }

    /// The first place that is never below it. The last is none.
    fn up(self, x: f32) -> u8 {
        (self.near(x).saturating_sub(2)..255).find(|&q| self.is_at_least(q, x)).unwrap_or(255)
    }

    /// The place below a number, or the one after it: a division in 64 bits rounds up to a whole number at most.
    fn near(self, x: f32) -> u8 {
        ((f64::from(x) - f64::from(self.origin)) / f64::from(self.step)) as u8
    }
}

#[cfg(test)]
mod tests;
