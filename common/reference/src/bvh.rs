//! A bounding volume hierarchy in f64: median split, iterative traversal, padded boxes.

use glam::DVec3;

use super::ray::Ray;

/// Items in a leaf; a box test costs about as much as a triangle test.
const LEAF: usize = 4;

/// Enough for any number of items: halving ends after 32 levels of `u32` indices.
const STACK: usize = 64;

/// The stand-in for 1/0: a ray within a box's slab must not make `0·∞`, which is NaN.
const HUGE: f64 = 1e300;

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// First item of a leaf, or the second child; the first child follows its parent.
    start: u32,
    /// Items of a leaf; 0 marks an inner node.
    count: u32,
}

/// A hierarchy over items that are known to it by their boxes alone.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

/// The smallest box around boxes.
fn around(boxes: impl IntoIterator<Item = (DVec3, DVec3)>) -> (DVec3, DVec3) {
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    boxes.into_iter().fold(nothing, |(low, high), (l, h)| (low.min(l), high.max(h)))
}

impl Bvh {
    /// Builds over boxes, each given by its least and its greatest corner; item i is box i.
    ///
    /// Every node is split at the median of its boxes' centres along the axis of their widest spread.
    pub fn new(boxes: &[(DVec3, DVec3)]) -> Self {
        let items = (0..boxes.len() as u32).collect();
        let mut bvh = Self { nodes: Vec::new(), items };
        if !boxes.is_empty() {
            bvh.split(boxes, 0, boxes.len());
        }
        bvh
    }

    fn split(&mut self, boxes: &[(DVec3, DVec3)], start: usize, end: usize) {
        let center = |item: u32| {
            let (low, high) = boxes[item as usize];
            low + high
        };
        let items = &mut self.items[start..end];
        let (low, high) = around(items.iter().map(|&item| boxes[item as usize]));
        let node = self.nodes.len();
        if items.len() <= LEAF {
            let (start, count) = (start as u32, items.len() as u32);
            self.nodes.push(Node { low, high, start, count });
            return;
        }
        let (least, greatest) = around(items.iter().map(|&item| (center(item), center(item))));
        let axis = (greatest - least).max_position();
        let half = items.len() / 2;
        items.select_nth_unstable_by(half, |&p, &q| center(p)[axis].total_cmp(&center(q)[axis]));
        self.nodes.push(Node { low, high, start: 0, count: 0 });
        self.split(boxes, start, start + half);
        self.nodes[node].start = self.nodes.len() as u32;
        self.split(boxes, start + half, end);
    }

    /// The box around all items; `None` without items.
    pub fn extent(&self) -> Option<(DVec3, DVec3)> {
        self.nodes.first().map(|root| (root.low, root.high))
    }

    /// Calls `visit` with every item whose box, grown by `pad` on all sides, the ray may meet.
    ///
    /// Nearer boxes come first, more or less. `visit` returns how far the ray still matters: the
    /// parameter of the nearest hit so far, or always `ray.tmax`; boxes beyond are left out.
    /// `pad` in world units must exceed f64's rounding, about 2^-50 of the largest coordinate; it
    /// also makes up for box tests that are rounded here and there.
    pub fn traverse(&self, ray: &Ray, pad: f64, mut visit: impl FnMut(u32) -> f64) {
        let reciprocal =
            DVec3::from_array(ray.direction.to_array().map(|d| d.recip().clamp(-HUGE, HUGE)));
        let mut tmax = ray.tmax;
        let enter = |node: &Node, tmax: f64| {
            let a = (node.low - pad - ray.origin) * reciprocal;
            let b = (node.high + pad - ray.origin) * reciprocal;
            let near = a.min(b).max_element().max(ray.tmin);
            let far = a.max(b).min_element().min(tmax);
            (near <= far).then_some(near)
        };
        let mut stack = [(0u32, 0f64); STACK];
        let mut depth = 0;
        if let Some(near) = self.nodes.first().and_then(|root| enter(root, tmax)) {
            stack[0] = (0, near);
            depth = 1;
        }
        while depth > 0 {
            depth -= 1;
            let (index, near) = stack[depth];
            if near > tmax {
                continue;
            }
            let node = &self.nodes[index as usize];
            let start = node.start as usize;
            for &item in &self.items[start..][..node.count as usize] {
                tmax = visit(item);
            }
            if node.count > 0 {
                continue;
            }
            let children = [index + 1, node.start];
            let [first, second] = children
                .map(|child| enter(&self.nodes[child as usize], tmax).map(|near| (child, near)));
            let later = first.zip(second).is_some_and(|(p, q)| p.1 <= q.1);
            // The farther child goes first onto the stack, so that the nearer one leaves it first.
            let order = if later { [second, first] } else { [first, second] };
            for child in order.into_iter().flatten() {
                stack[depth] = child;
                depth += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::aabb::Aabb;
    use super::super::random::{Random, towards};
    use super::*;

    fn boxes(random: &mut Random, n: usize) -> Vec<(DVec3, DVec3)> {
        (0..n)
            .map(|i| {
                let center = random.in_cube() * 10.0;
                // Every third one is flat, as a floor's triangles are.
                let mut size = random.in_cube().abs();
                size.y *= f64::from(i % 3 != 0);
                (center - size, center + size)
            })
            .collect()
    }

    #[test]
    fn visits_every_box_that_the_ray_meets() {
        let mut random = Random(20);
        for n in [0, 1, 4, 5, 300] {
            let boxes = boxes(&mut random, n);
            let bvh = Bvh::new(&boxes);
            for round in 0..200 {
                let mut ray = towards(random.in_cube() * 20.0, random.in_cube() * 8.0);
                if round % 4 == 0 && n > 0 {
                    // Along an axis, within a face of a box.
                    ray.origin = boxes[random.below(n)].0;
                    ray.origin[round % 3] = -50.0;
                    ray.direction = DVec3::AXES[round % 3];
                }
                let mut visited = vec![0; n];
                bvh.traverse(&ray, 1e-12, |item| {
                    visited[item as usize] += 1;
                    ray.tmax
                });
                for (i, &(low, high)) in boxes.iter().enumerate() {
                    assert!(visited[i] <= 1);
                    let aabb = Aabb { low, high };
                    if aabb.intersect(&ray).is_some() {
                        assert_eq!(visited[i], 1, "{ray:?} {low} {high}");
                    }
                }
            }
        }
    }

    #[test]
    fn leaves_out_what_lies_beyond_or_beside() {
        let mut random = Random(21);
        let bvh = Bvh::new(&boxes(&mut random, 4000));
        let ray = towards(DVec3::splat(-30.0), DVec3::ZERO);
        let (mut all, mut first) = (0, 0);
        bvh.traverse(&ray, 0.0, |_| {
            all += 1;
            ray.tmax
        });
        bvh.traverse(&ray, 0.0, |_| {
            first += 1;
            0.0
        });
        assert!((1..400).contains(&all) && first <= LEAF && first < all, "{all} {first}");
    }

    #[test]
    fn coinciding_boxes_are_split_all_the_same() {
        let bvh = Bvh::new(&[(DVec3::ZERO, DVec3::ONE); 1000]);
        let ray = towards(DVec3::splat(-1.0), DVec3::splat(0.5));
        let mut visited = 0;
        bvh.traverse(&ray, 1e-12, |_| {
            visited += 1;
            ray.tmax
        });
        assert_eq!(visited, 1000);
    }
}
