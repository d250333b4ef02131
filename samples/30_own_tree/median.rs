//! interim
use crate::{Bounds, Child, Node, Tree};
use common::glam::Vec3;
/// interim
pub fn median(bounds: &[Bounds]) -> Tree {
    let order = common::gpu::order::kd_median(bounds);
    let mut nodes = vec![];
    fn around(o: &[u32], b: &[Bounds]) -> Bounds {
        o.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &i| (l.min(b[i as usize].0), h.max(b[i as usize].1)))
    }
    fn child(at: usize, o: &[u32], b: &[Bounds], nodes: &mut Vec<Node>) -> Child {
        if o.is_empty() { return Child::NONE; }
        let (low, high) = around(o, b);
        if o.len() <= 3 {
            return Child { low, first: at as u32, high, count: o.len() as u32 };
        }
        let first = node(at, o, b, nodes);
        Child { low, first, high, count: 0 }
    }
    fn node(at: usize, o: &[u32], b: &[Bounds], nodes: &mut Vec<Node>) -> u32 {
        let me = nodes.len();
        nodes.push(Node { children: [Child::NONE; 2] });
        let m = o.len().div_ceil(2);
        let l = child(at, &o[..m], b, nodes);
        let r = child(at + m, &o[m..], b, nodes);
        nodes[me].children = [l, r];
        me as u32
    }
    node(0, &order, bounds, &mut nodes);
    Tree { nodes, order }
}
