//! Builders of the trees.

use anyhow::{Context, Result};
use common::gpu::{Buffer, Gpu};
use common::model::text::quoted;
use common::scene::Mesh;

use crate::binned::binned_into;
use crate::check::check_links;
use crate::reinsert::reinserted_into;
use crate::subtree::FOLDED;
use crate::{Bounds, Corners, DeviceBuilder, DeviceTree, Scratch, Tree, Triangles};

common::shader_enum! {
    /// The builder of the meshes' trees. The tree over the instances is built on the host.
    pub enum Builder {
        /// From the root down, by the surface area heuristic.
        Binned,
        /// The same, and then badly placed parts are moved to better places.
        Reinserted,
        /// On the device, along a curve through space.
        Device,
    }
}

/// Number of passes over the whole tree in search of badly placed nodes.
const ROUNDS: u32 = 3;

impl Builder {
    /// A tree over boxes, built on the host.
    pub fn over(self, bounds: &[Bounds]) -> Tree {
        self.into_leaves(bounds, FOLDED)
    }

    /// A tree over the boxes of instances. To enter one costs a ray as much as several nodes, so no two share a
    /// leaf: a ray that meets the leaf would enter both.
    pub fn over_instances(self, bounds: &[Bounds]) -> Tree {
        self.into_leaves(bounds, 1)
    }

    fn into_leaves(self, bounds: &[Bounds], most: u32) -> Tree {
        let tree = binned_into(bounds, most);
        if self == Self::Reinserted { reinserted_into(tree, bounds, ROUNDS, most) } else { tree }
    }

    /// A tree over the triangles of each mesh, whose corners are `triangles`.
    ///
    /// # Errors
    /// If the device has no room for them, or what it built is not a tree.
    pub fn trees(
        self,
        gpu: &Gpu,
        meshes: &[Mesh],
        triangles: &[Vec<Corners>],
    ) -> Result<Vec<Tree>> {
        if self == Self::Device {
            let builder = DeviceBuilder::new(gpu)?;
            meshes.iter().map(|mesh| on_device(gpu, &builder, mesh)).collect()
        } else {
            let tree = |triangles: &Vec<Corners>| {
                let bounds: Vec<_> = triangles.iter().map(Corners::bounds).collect();
                self.over(&bounds)
            };
            Ok(triangles.iter().map(tree).collect())
        }
    }
}

/// The device's tree. It is read back only to be packed with the others: a program that builds anew in each frame
/// would walk it where it lies.
fn on_device(gpu: &Gpu, builder: &DeviceBuilder, mesh: &Mesh) -> Result<Tree> {
    let vertices = Buffer::with_data(gpu, "vertices", &mesh.vertices, Buffer::ADDRESSED)?;
    let triangles = Buffer::with_data(gpu, "triangles", &mesh.triangles, Buffer::ADDRESSED)?;
    let count = mesh.triangles.len() as u32;
    let list = Triangles { vertices: vertices.address, triangles: triangles.address, count };
    let (tree, scratch) = (DeviceTree::new(gpu, count)?, Scratch::new(gpu, count)?);
    gpu.submit(|cmd| builder.record(cmd, list, &tree, &scratch))?;
    let mut read = Tree { nodes: tree.nodes.read()?, order: tree.original.read()? };
    // Vulkan has no empty buffers.
    read.order.truncate(count as usize);
    check_links(&read, count as usize)
        .with_context(|| format!("the device's tree of the mesh {}", quoted(&mesh.name)))?;
    Ok(read)
}
