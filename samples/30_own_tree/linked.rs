//! A tree whose parts know their parents, so that one can be taken out and put in elsewhere.

use std::iter;
use std::ops::{Index, IndexMut, Range};

use crate::check::DEPTH;
use crate::hull::Hull;
use crate::subtree::Subtree;
use crate::tree::{Bounds, Child, Node, Tree};

/// The parent of the root, and in place of a leaf's second child.
pub(crate) const NOBODY: u32 = u32::MAX;

/// A primitive, or two parts.
pub(crate) struct Part {
    /// The box around it.
    pub hull: Hull,
    /// Half the surface area of the box.
    pub area: f64,
    /// The part that it is half of.
    pub parent: u32,
    /// Number of parts of two on the longest way down, this one among them.
    pub height: u32,
    /// Two parts, or a primitive and nobody.
    children: [u32; 2],
}

impl Part {
    /// The two that it consists of; none for a primitive.
    pub fn children(&self) -> Option<[u32; 2]> {
        (self.children[1] != NOBODY).then_some(self.children)
    }
}

/// A tree of parts, each of one primitive or of two parts.
pub(crate) struct Linked {
    parts: Vec<Part>,
    root: u32,
}

impl Index<u32> for Linked {
    type Output = Part;

    fn index(&self, at: u32) -> &Part {
        &self.parts[at as usize]
    }
}

impl IndexMut<u32> for Linked {
    fn index_mut(&mut self, at: u32) -> &mut Part {
        &mut self.parts[at as usize]
    }
}

impl Linked {
    /// The same tree, its leaves taken apart. None over nothing.
    pub fn new(tree: &Tree, bounds: &[Bounds]) -> Option<Self> {
        let mut linked = Self { parts: Vec::with_capacity(2 * tree.order.len()), root: NOBODY };
        linked.root = linked.add_node(tree, bounds, 0)?;
        Some(linked)
    }

    fn add_node(&mut self, tree: &Tree, bounds: &[Bounds], node: u32) -> Option<u32> {
        let [a, b] = tree.nodes[node as usize].children.map(|child| match child.node() {
            Some(node) => self.add_node(tree, bounds, node),
            None => self.add_leaf(&tree.order, bounds, child.positions()),
        });
        a.zip(b).map(|(a, b)| self.add([a, b])).or(a).or(b)
    }

    fn add_leaf(&mut self, order: &[u32], bounds: &[Bounds], at: Range<usize>) -> Option<u32> {
        if at.len() > 1 {
            let middle = (at.start + at.end) / 2;
            let a = self.add_leaf(order, bounds, at.start..middle)?;
            let b = self.add_leaf(order, bounds, middle..at.end)?;
            return Some(self.add([a, b]));
        }
        let primitive = *order[at].first()?;
        let hull = Hull::from(bounds[primitive as usize]);
        let (area, children) = (hull.half_area(), [primitive, NOBODY]);
        self.parts.push(Part { hull, area, parent: NOBODY, height: 0, children });
        Some(self.len() - 1)
    }

    fn add(&mut self, children: [u32; 2]) -> u32 {
        let at = self.len();
        let hull = Hull::EMPTY;
        self.parts.push(Part { hull, area: 0.0, parent: NOBODY, height: 0, children });
        self.renew(at);
        for child in children {
            self[child].parent = at;
        }
        at
    }

    /// Number of parts.
    pub fn len(&self) -> u32 {
        self.parts.len() as u32
    }

    /// A part, its parent, and so on to the root.
    pub fn upward(&self, at: u32) -> impl Iterator<Item = u32> {
        let is_there = |at: u32| (at != NOBODY).then_some(at);
        iter::successors(is_there(at), move |&at| is_there(self[at].parent))
    }

    /// The other part of two.
    pub fn other(&self, parent: u32, child: u32) -> u32 {
        let [a, b] = self[parent].children;
        if a == child { b } else { a }
    }

    /// Takes a part out, and its parent, whose place the sibling takes. By how much the boxes above shrink.
    pub fn take_out(&mut self, part: u32) -> f64 {
        let parent = self[part].parent;
        let sibling = self.other(parent, part);
        self.replace(parent, sibling);
        self.renew_upward(self[sibling].parent)
    }

    /// Puts a part that was taken out beside another, with the parent that it had.
    pub fn put_in(&mut self, part: u32, parent: u32, beside: u32) {
        self.replace(beside, parent);
        self[parent].children = [beside, part];
        self[beside].parent = parent;
        self[part].parent = parent;
        self.renew(parent);
        self.renew_upward(self[parent].parent);
    }

    /// Puts a part into another's place.
    fn replace(&mut self, old: u32, new: u32) {
        let parent = self[old].parent;
        self[new].parent = parent;
        if parent == NOBODY {
            self.root = new;
        } else {
            self[parent].children = [new, self.other(parent, old)];
        }
    }

    /// Measures a part of two again. Returns whether it has changed, and by how much its area has shrunk.
    fn renew(&mut self, at: u32) -> (bool, f64) {
        let [a, b] = self[at].children;
        let (hull, height) =
            (self[a].hull.join(&self[b].hull), 1 + self[a].height.max(self[b].height));
        let part = &mut self[at];
        let has_changed = (hull, height) != (part.hull, part.height);
        let area = hull.half_area();
        let shrunk = part.area - area;
        (part.hull, part.height, part.area) = (hull, height, area);
        (has_changed, shrunk)
    }

    /// As `renew`, of all from a part to the root, until nothing changes.
    fn renew_upward(&mut self, mut at: u32) -> f64 {
        let mut all = 0.0;
        while at != NOBODY {
            let (has_changed, shrunk) = self.renew(at);
            all += shrunk;
            at = if has_changed { self[at].parent } else { NOBODY };
        }
        all
    }

    /// The tree for a shader, small parts folded into leaves of at most `most` primitives.
    pub fn into_tree(self, most: u32) -> Tree {
        let (mut nodes, mut order) = (Vec::new(), Vec::new());
        let root = self.subtree((self.root, 1), most, &mut nodes, &mut order);
        root.into_tree(nodes, order)
    }

    fn subtree(
        &self,
        (at, level): (u32, u32),
        most: u32,
        nodes: &mut Vec<Node>,
        order: &mut Vec<u32>,
    ) -> Subtree {
        let first = order.len() as u32;
        let Part { hull, children, .. } = self[at];
        let Some(children) = self[at].children() else {
            order.push(children[0]);
            return Subtree::leaf(hull, first, 1);
        };
        let at = nodes.len();
        nodes.push(Node { children: [Child::NONE; 2] });
        let children = children.map(|child| self.subtree((child, level + 1), most, nodes, order));
        // Taken apart, a leaf on the last level has levels below it that no tree may have.
        if level > DEPTH {
            nodes.truncate(at);
            return Subtree::leaf(hull, first, order.len() as u32 - first);
        }
        Subtree::join(nodes, at, children, most)
    }
}
