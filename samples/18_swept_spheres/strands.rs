//! Chains of swept spheres: segments between nodes.

use common::gpu::order::Bounds;
use common::gpu::{Address, sphere_bounds};
use glam::Vec3;

common::shader_struct! {
    /// An end of segments: a sphere.
    #[derive(PartialEq)]
    pub struct Node {
        /// Its middle.
        pub center: Vec3,
        /// 0 or more. Where it is 0, a segment ends in a tip.
        pub radius: f32,
    }
}

common::shader_struct! {
    /// A sphere swept from the node `first` to the one after it.
    pub struct Segment {
        /// The number of the node where it begins.
        pub first: u32,
        /// The material, by position in the model.
        pub material: u32,
    }
}

common::shader_struct! {
    /// Addresses of the strands, and the segment of each primitive of the build.
    pub struct StrandAddresses {
        /// All nodes, chain after chain.
        pub nodes: Address<Node>,
        /// All segments.
        pub segments: Address<Segment>,
        /// The segment of each primitive of the build.
        pub ids: Address,
    }
}

/// All segments of a scene.
#[derive(Clone, Default)]
pub struct Strands {
    /// Ends of segments, chain after chain.
    pub nodes: Vec<Node>,
    /// In the order in which they were added.
    pub segments: Vec<Segment>,
}

impl Strands {
    /// Segments from each node to the next: two that share an end share its numbers.
    pub fn chain(&mut self, nodes: impl IntoIterator<Item = Node>, material: u32) {
        let first = self.nodes.len() as u32;
        self.nodes.extend(nodes);
        let last = self.nodes.len() as u32;
        self.segments.extend((first + 1..last).map(|next| Segment { first: next - 1, material }));
    }

    /// Corners of the box around each segment: the box around both of its end spheres, for what the segment
    /// adds to them lies between them. Never smaller by rounding.
    pub fn bounds(&self) -> Vec<Bounds> {
        let around = |segment: &Segment| {
            let [a, b] = [0, 1].map(|i| self.nodes[segment.first as usize + i].bounds());
            (a.0.min(b.0), a.1.max(b.1))
        };
        self.segments.iter().map(around).collect()
    }
}

impl Node {
    /// Corners of the box around it, never inside it by rounding.
    fn bounds(&self) -> Bounds {
        sphere_bounds(self.center, self.radius)
    }
}
