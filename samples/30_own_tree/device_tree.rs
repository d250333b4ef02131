//! Results of a build on the device, and the memory that it needs meanwhile.

use anyhow::{Result, ensure};
use ash::vk::BufferUsageFlags as Usage;
use common::glam::Vec3;
use common::gpu::{Address, Buffer, Gpu};

use crate::hull::NOWHERE;
use crate::on_device::{DIGITS, EXTENT_SHARES, MOST_SHARES, bytes};
use crate::tree::{self, Node};

/// The most triangles of one tree: positions are signed where the hierarchy is made, and twice as far is looked.
pub const MOST_TRIANGLES: u32 = 1 << 29;

common::shader_struct! {
    /// The corners of a triangle. 36 bytes.
    pub struct Corners {
        /// The first.
        pub a: Vec3,
        /// The second.
        pub b: Vec3,
        /// The third.
        pub c: Vec3,
    }
}

impl Corners {
    /// The least box around them. A triangle that is not finite has none.
    pub fn bounds(&self) -> tree::Bounds {
        let Self { a, b, c } = self;
        if [a, b, c].iter().all(|corner| corner.is_finite()) {
            (a.min(*b).min(*c), a.max(*b).max(*c))
        } else {
            NOWHERE
        }
    }
}

common::shader_struct! {
    /// A box, low and high corner.
    pub(crate) struct Bounds {
        low: Vec3,
        high: Vec3,
    }
}

common::shader_struct! {
    /// The extent of some triangles' centres, and the number of finite triangles.
    pub(crate) struct Extent {
        low: Vec3,
        count: u32,
        high: Vec3,
    }
}

/// A tree on the device: for each triangle 64 bytes of nodes, 36 of corners, 4 to name it, and 4 for a refit.
pub struct DeviceTree {
    /// The [`Node`]s, the root first: one less than triangles, and at least one. A leaf is one triangle.
    pub nodes: Buffer,
    /// The index, a `u32`, of the triangle at each position that leaves refer to.
    pub original: Buffer,
    /// The [`Corners`] of the triangle at each position.
    pub corners: Buffer,
    /// Number of triangles.
    pub count: u32,
    /// The end, a `u32`, of each node's range of positions; the other end is the node's own index.
    pub(crate) ends: Buffer,
}

impl DeviceTree {
    /// Memory for a tree of `count` triangles, not built yet.
    ///
    /// # Errors
    /// If there are more than [`MOST_TRIANGLES`], or memory is short.
    pub fn new(gpu: &Gpu, count: u32) -> Result<Self> {
        ensure!(
            count <= MOST_TRIANGLES,
            "{count} triangles are too many for one tree, {MOST_TRIANGLES} the most"
        );
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS | Usage::TRANSFER_SRC;
        let make = |name: &str, bytes: u64| Buffer::new(gpu, name, bytes, usage);
        let nodes_count = nodes_count(count);
        Ok(Self {
            nodes: make("nodes", bytes::<Node>(nodes_count))?,
            original: make("tree order", bytes::<u32>(count))?,
            corners: make("tree corners", bytes::<Corners>(count))?,
            ends: make("node ranges", bytes::<u32>(nodes_count))?,
            count,
        })
    }

    /// Number of nodes.
    pub fn nodes_count(&self) -> u32 {
        nodes_count(self.count)
    }

    /// Maximum number of nodes on a path from the root, and so the entries in the stack of a walk that keeps one
    /// child of each node for later: at most 59.
    ///
    /// All positions of a node share a prefix of their keys, which are 30 bits and then, where these are the same,
    /// the position itself; a node below it has positions that share more. So a path has no more nodes than there
    /// are lengths of a prefix: one for each of the 30 bits, and one for each bit of a position.
    pub fn most_depth(&self) -> u32 {
        let bits_of_a_position = u32::BITS - self.count.saturating_sub(1).leading_zeros();
        (30 + bits_of_a_position).min(self.nodes_count())
    }
}

fn nodes_count(triangles: u32) -> u32 {
    triangles.saturating_sub(1).max(1)
}

/// Memory of builds and refits beside a tree, one at a time: 64 bytes per triangle, and 2 MiB.
pub struct Scratch {
    /// Maximum number of triangles in a tree.
    pub most: u32,
    pub(crate) extents: Address<Extent>,
    pub(crate) keys: [Address; 2],
    pub(crate) values: Address,
    pub(crate) counts: Address,
    pub(crate) totals: Address,
    /// Around each position, around each pair, and so on up to one around all.
    pub(crate) boxes: Address<Bounds>,
    _buffer: Buffer,
}

impl Scratch {
    /// Scratch memory for trees of at most so many triangles.
    ///
    /// # Errors
    /// If there are more than [`MOST_TRIANGLES`], or memory is short.
    pub fn new(gpu: &Gpu, most: u32) -> Result<Self> {
        ensure!(
            most <= MOST_TRIANGLES,
            "{most} triangles are too many for one tree, {MOST_TRIANGLES} the most"
        );
        let words = bytes::<u32>(most);
        // Each level has half as many as the one below it, and one more if that is odd.
        let boxes = bytes::<Bounds>(2 * most + u32::BITS);
        let sizes = [
            bytes::<Extent>(1 + EXTENT_SHARES),
            words,
            words,
            words,
            bytes::<u32>(DIGITS * MOST_SHARES),
            bytes::<u32>(DIGITS),
            boxes,
        ];
        let mut size = 0;
        let offsets = sizes.map(|part| {
            let offset = size;
            size += part.next_multiple_of(common::gpu::ADDRESS_ALIGNMENT);
            offset
        });
        let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
        let buffer = Buffer::new(gpu, "scratch of trees", size, usage)?;
        let [extents, keys, other_keys, values, counts, totals, boxes] =
            offsets.map(|offset| buffer.address + offset);
        Ok(Self {
            most,
            extents: extents.into(),
            keys: [keys.into(), other_keys.into()],
            values: values.into(),
            counts: counts.into(),
            totals: totals.into(),
            boxes: boxes.into(),
            _buffer: buffer,
        })
    }
}
