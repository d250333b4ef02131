//! A better tree from a tree: each part of it is taken out, and put back where it costs least.
//!
//! After Bittner et al., "Fast insertion-based optimization of bounding volume hierarchies" (2013); places
//! are searched as in Meister and Bittner, "Parallel reinsertion for bounding volume hierarchy optimization"
//! (2018): for all parts of a tree that does not change meanwhile, so that each thread may search. But the moves
//! are made one by one, the most promising first, and each only if it still pays.

use common::workers;

use crate::check::DEPTH;
use crate::linked::{Linked, NOBODY};
use crate::subtree::FOLDED;
use crate::tree::{Bounds, Tree};

/// Parts for which a thread searches at a time.
const SEARCHED: u32 = 512;

/// A better tree over the same primitives, no deeper than [`DEPTH`], after some rounds, or fewer if no part has
/// a better place any more. The same bytes however many threads there are.
///
/// Leaves are taken apart before, and made anew in the end. Each move makes the sum of all areas smaller that
/// the tree has meanwhile; the cost of the tree with its leaves follows it, but no move is held to that.
/// Boxes are made anew from `bounds`.
///
/// # Panics
/// If the tree is none over these boxes: see [`check`](crate::check()).
pub fn reinserted(tree: Tree, bounds: &[Bounds], rounds: u32) -> Tree {
    reinserted_into(tree, bounds, rounds, FOLDED)
}

/// The same with at most so many primitives in a leaf.
pub(crate) fn reinserted_into(tree: Tree, bounds: &[Bounds], rounds: u32, most: u32) -> Tree {
    let Some(mut linked) = Linked::new(&tree, bounds) else { return tree };
    for _ in 0..rounds {
        if !linked.round() {
            break;
        }
    }
    linked.into_tree(most)
}

/// A place for a part: beside another.
struct Move {
    /// The reduction of the sum of all areas.
    gain: f64,
    part: u32,
    beside: u32,
}

impl Linked {
    /// Looks for a better place for each part, and moves it there. Returns whether any has moved.
    fn round(&mut self) -> bool {
        let parts = self.len();
        let starts: Vec<u32> = (0..parts).step_by(SEARCHED as usize).collect();
        let found = workers::each(&starts, |&start| {
            let parts = start..parts.min(start + SEARCHED);
            parts.filter_map(|part| self.best_move(part)).collect::<Vec<Move>>()
        });
        let mut moves: Vec<Move> = found.into_iter().flatten().collect();
        moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.part.cmp(&b.part)));
        let mut moved = false;
        for Move { part, beside, .. } in moves {
            moved |= self.move_if_better(part, beside);
        }
        moved
    }

    /// The best place for a part, if it is better than the present one.
    ///
    /// Where it is taken from, its parent goes with it, and the boxes above shrink. On the way to a place all
    /// boxes grow, and there is a new parent. Wider and wider surroundings are searched, and no box is opened
    /// if even a parent no larger than the part would be too much below it.
    fn best_move(&self, part: u32) -> Option<Move> {
        let (hull, least) = (&self[part].hull, self[part].area);
        let mut best = Move { gain: 0.0, part, beside: NOBODY };
        let mut above = self[part].parent;
        if above == NOBODY {
            return None;
        }
        let sibling = self.other(above, part);
        // The part of `above` that stays, and the areas saved below and by it.
        let (mut rest, mut saved) = (self[sibling].hull, self[above].area);
        let mut stack = vec![(sibling, saved)];
        loop {
            while let Some((beside, saved)) = stack.pop() {
                if saved - least <= best.gain {
                    continue;
                }
                let around = self[beside].hull.join(hull).half_area();
                if saved - around > best.gain {
                    (best.gain, best.beside) = (saved - around, beside);
                }
                if let Some(children) = self[beside].children() {
                    stack.extend(children.map(|child| (child, saved - around + self[beside].area)));
                }
            }
            let from = above;
            above = self[above].parent;
            if above == NOBODY {
                return (best.beside != NOBODY).then_some(best);
            }
            let other = self.other(above, from);
            stack.push((other, saved));
            rest = rest.join(&self[other].hull);
            saved += self[above].area - rest.half_area();
        }
    }

    /// Moves a part beside another, if that makes all areas together smaller and no way too long.
    fn move_if_better(&mut self, part: u32, beside: u32) -> bool {
        let above = self[part].parent;
        // An earlier move may have changed the surroundings.
        if above == NOBODY || beside == above || self.upward(beside).any(|at| at == part) {
            return false;
        }
        let sibling = self.other(above, part);
        let saved = self[above].area + self.take_out(part);
        let mut level = 0;
        let mut cost = self[beside].area;
        for at in self.upward(beside) {
            level += 1;
            cost += self[at].hull.join(&self[part].hull).half_area() - self[at].area;
        }
        let deepest = level + self[part].height.max(self[beside].height);
        let is_better = cost < saved && deepest <= DEPTH;
        self.put_in(part, above, if is_better { beside } else { sibling });
        is_better
    }
}

#[cfg(test)]
mod tests;
