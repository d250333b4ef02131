//! A tree from the top down, by the surface area heuristic over a few planes.
//!
//! The cost of a plane follows from the boxes and the counts on its two sides (MacDonald and Booth 1990).
//! Instead of a plane beside each primitive, 15 along each axis are tried: the primitives are counted
//! in 16 bins between them (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007).

use std::num::NonZero;
use std::panic;
use std::sync::atomic::{AtomicIsize, Ordering};
use std::thread::{self, Builder};

use crate::check::DEPTH;
use crate::hull::{Hull, has_place};
use crate::subtree::{FOLDED, Subtree};
use crate::tree::{Bounds, Child, Node, Tree};

/// Bins along an axis.
const BINS: usize = 16;

/// A part with fewer primitives is not worth a thread.
const GRAIN: usize = 4096;

/// A tree over boxes, by as many threads as there are processors; the same bytes however many.
///
/// A primitive whose box is not finite, or is inside out, is in no leaf: `order` has only the others.
/// No walk passes more than [`DEPTH`] nodes, and leaves hold at most four primitives.
/// The time is O(n log n) for usual boxes, and at most O([`DEPTH`] · n) for any.
///
/// # Panics
/// Beyond 2^32 boxes.
pub fn binned(bounds: &[Bounds]) -> Tree {
    binned_into(bounds, FOLDED)
}

/// The same with at most so many primitives in a leaf.
pub(crate) fn binned_into(bounds: &[Bounds], most: u32) -> Tree {
    binned_on(bounds, most, thread::available_parallelism().map_or(1, NonZero::get))
}

fn binned_on(bounds: &[Bounds], most: u32, threads: usize) -> Tree {
    assert!(u32::try_from(bounds.len()).is_ok(), "{} boxes: 32 bits count them", bounds.len());
    let boxes = bounds.iter().enumerate().filter(|(_, bounds)| has_place(bounds));
    let mut primitives: Vec<Primitive> = boxes
        .map(|(index, &bounds)| Primitive { hull: bounds.into(), index: index as u32 })
        .collect();
    let growth = Growth { most, idle: AtomicIsize::new(threads as isize - 1) };
    let mut nodes = Vec::new();
    let root = growth.grow(&mut primitives, 0, 1, &mut nodes);
    root.into_tree(nodes, primitives.iter().map(|primitive| primitive.index).collect())
}

/// A primitive on its way into a leaf. Its box travels with it: a part's boxes lie side by side in memory.
#[derive(Clone, Copy)]
struct Primitive {
    hull: Hull,
    index: u32,
}

/// A build.
struct Growth {
    /// Maximum number of primitives in a leaf.
    most: u32,
    /// Number of further threads that may be at work.
    idle: AtomicIsize,
}

impl Growth {
    /// The tree over a part that begins at position `first`, its root on a level; the root of all is on level 1.
    /// Nodes are appended: a node, all below its first child, all below its second.
    fn grow(
        &self,
        part: &mut [Primitive],
        first: u32,
        level: u32,
        nodes: &mut Vec<Node>,
    ) -> Subtree {
        let count = part.len() as u32;
        if count <= 1 || level > DEPTH {
            let hull = part.iter().fold(Hull::EMPTY, |hull, one| hull.join(&one.hull));
            return Subtree::leaf(hull, first, count);
        }
        let at = nodes.len();
        nodes.push(Node { children: [Child::NONE; 2] });
        let middle = split(part, most_below(self.most, level));
        let (left, right) = part.split_at_mut(middle);
        let (second, level) = (first + middle as u32, level + 1);
        let children = if left.len().min(right.len()) >= GRAIN && self.has_idle() {
            self.grow_beside((left, first), (right, second), level, nodes)
        } else {
            [self.grow(left, first, level, nodes), self.grow(right, second, level, nodes)]
        };
        Subtree::join(nodes, at, children, self.most)
    }

    /// As two calls of `grow`, the second on a thread of its own.
    fn grow_beside(
        &self,
        left: (&mut [Primitive], u32),
        right: (&mut [Primitive], u32),
        level: u32,
        nodes: &mut Vec<Node>,
    ) -> [Subtree; 2] {
        let mut beyond = Vec::new();
        let (a, b) = thread::scope(|scope| {
            let second = Builder::new().spawn_scoped(scope, || {
                let grown = self.grow(right.0, right.1, level, &mut beyond);
                self.idle.fetch_add(1, Ordering::Relaxed);
                grown
            });
            let a = self.grow(left.0, left.1, level, nodes);
            // Whichever is done first leaves its processor to others; the one that comes back here goes on.
            self.idle.fetch_add(1, Ordering::Relaxed);
            let b = second.map(|b| b.join().unwrap_or_else(|panic| panic::resume_unwind(panic)));
            self.idle.fetch_sub(1, Ordering::Relaxed);
            (a, b.ok())
        });
        // If the system starts no more threads, this one does the work.
        let mut b = b.unwrap_or_else(|| self.grow(right.0, right.1, level, &mut beyond));
        let before = nodes.len() as u32;
        for child in beyond.iter_mut().flat_map(|node| &mut node.children) {
            child.first += if child.count == 0 { before } else { 0 };
        }
        nodes.append(&mut beyond);
        b.node = b.node.map(|node| node + before);
        [a, b]
    }

    /// Takes a thread, if there is one.
    fn has_idle(&self) -> bool {
        let take = |idle| (idle > 0).then(|| idle - 1);
        self.idle.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take).is_ok()
    }
}

/// The most primitives that fit below a node on a level: what a leaf may have on the last, and twice as many on each
/// level above.
fn most_below(most: u32, level: u32) -> u64 {
    u64::from(most) << (DEPTH - level)
}

/// Puts two primitives or more into two parts, and says how many are in the first. Neither has more than `most`.
///
/// The best plane may leave all but a few on one side, again and again. What no longer fits below that side is
/// halved instead, as is what no plane divides: so the depth is bounded.
fn split(part: &mut [Primitive], most: u64) -> usize {
    if part.len() == 2 {
        return 1;
    }
    let grid = Grid::around(part);
    if let Some((axis, plane)) = Bins::of(part, &grid).best() {
        let middle = partition(part, |one| grid.place(&one.hull, axis) < plane as f32);
        if middle.max(part.len() - middle) as u64 <= most {
            return middle;
        }
    }
    let middle = part.len() / 2;
    let place = |one: &Primitive| one.hull.half_middle(grid.longest);
    part.select_nth_unstable_by(middle, |a, b| {
        place(a).total_cmp(&place(b)).then(a.index.cmp(&b.index))
    });
    middle
}

/// Puts those first of which `is_first` is true, and says how many they are. Each is moved, whether it must be
/// or not: a processor would guess the answers, and half its guesses would be wrong.
fn partition(part: &mut [Primitive], is_first: impl Fn(&Primitive) -> bool) -> usize {
    let mut firsts = 0;
    for i in 0..part.len() {
        part.swap(firsts, i);
        firsts += usize::from(is_first(&part[firsts]));
    }
    firsts
}

/// The bins of a part: from the first middle of a primitive to the last.
struct Grid {
    low: [f32; 3],
    /// Bins a unit of length.
    density: [f32; 3],
    /// The axis along which the middles go farthest.
    longest: usize,
    /// Number of bins per axis.
    bins: usize,
}

impl Grid {
    fn around(part: &[Primitive]) -> Self {
        let middle =
            |one: &Primitive| Hull::point([0, 1, 2].map(|axis| one.hull.half_middle(axis)));
        let middles = part.iter().fold(Hull::EMPTY, |hull, one| hull.join(&middle(one)));
        let axes = [0, 1, 2];
        let sides = axes.map(|axis| middles.side(axis));
        let longest = axes.into_iter().max_by(|&a, &b| sides[a].total_cmp(&sides[b])).unwrap_or(0);
        // A few primitives need no more bins than they are.
        let bins = BINS.min(part.len());
        // If they are all in one place, or nearly so, there is one bin.
        let density = sides.map(|side| bins as f32 / side);
        let density = density.map(|density| if density.is_finite() { density } else { 0.0 });
        Self { low: axes.map(|axis| middles.low(axis)), density, longest, bins }
    }

    /// The place of a primitive, in bins from the first's start.
    fn place(&self, hull: &Hull, axis: usize) -> f32 {
        (hull.half_middle(axis) - self.low[axis]) * self.density[axis]
    }

    fn bin(&self, hull: &Hull, axis: usize) -> usize {
        (self.place(hull, axis) as usize).min(self.bins - 1)
    }
}

/// Contents of the bins along each axis: the box around the primitives, and their number.
struct Bins<'a> {
    bins: [[(Hull, u32); BINS]; 3],
    grid: &'a Grid,
}

impl<'a> Bins<'a> {
    fn of(part: &[Primitive], grid: &'a Grid) -> Self {
        let mut bins = [[(Hull::EMPTY, 0); BINS]; 3];
        for primitive in part {
            for (axis, bins) in bins.iter_mut().enumerate() {
                let (hull, count) = &mut bins[grid.bin(&primitive.hull, axis)];
                *hull = hull.join(&primitive.hull);
                *count += 1;
            }
        }
        Self { bins, grid }
    }

    /// The axis and the first bin behind the plane of least cost. None if all are in one bin.
    ///
    /// A ray that meets the part meets one side of a plane as often as the areas say, and then its primitives.
    fn best(&self) -> Option<(usize, usize)> {
        let mut best = (f64::INFINITY, None);
        for (axis, bins) in self.bins.iter().enumerate() {
            let bins = &bins[..self.grid.bins];
            let mut before = [0.0; BINS];
            let mut so_far = (Hull::EMPTY, 0);
            for (cost, bin) in before.iter_mut().zip(bins) {
                *cost = add(&mut so_far, bin);
            }
            let mut so_far = (Hull::EMPTY, 0);
            for plane in (1..bins.len()).rev() {
                let cost = before[plane - 1] + add(&mut so_far, &bins[plane]);
                if cost < best.0 {
                    best = (cost, Some((axis, plane)));
                }
            }
        }
        best.1
    }
}

/// Adds a bin to those so far, and says what they cost: area times count; ∞ where there are none.
fn add(so_far: &mut (Hull, u32), bin: &(Hull, u32)) -> f64 {
    *so_far = (so_far.0.join(&bin.0), so_far.1 + bin.1);
    if so_far.1 == 0 { f64::INFINITY } else { so_far.0.half_area() * f64::from(so_far.1) }
}

#[cfg(test)]
mod tests;
