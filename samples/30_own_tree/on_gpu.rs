//! A scene's trees in device memory: one for each mesh, and one over its instances.

use anyhow::{Result, ensure};
use common::glam::{DAffine3, DVec3, Vec3};
use common::gpu::{Address, Buffer, Gpu};
use common::scene::{Instance, Mesh, Scene};

use crate::hull::NOWHERE;
use crate::{Bounds, Builder, Corners, Node, Quantised, depth, quantised};

common::shader_struct! {
    /// An instance, at its position in the top tree's order. 116 bytes.
    pub struct Placed {
        /// Columns of the matrix from the mesh's space to the world.
        pub to_world: [Vec3; 4],
        /// Columns of its inverse.
        pub to_object: [Vec3; 4],
        /// The node at the root of the mesh's tree.
        pub root: u32,
        /// Index of the mesh's first corner.
        pub first: u32,
        /// Number of triangles in the mesh.
        pub count: u32,
        /// Index of the instance in the scene.
        pub number: u32,
        /// The largest coordinate of the mesh, without its sign.
        pub reach: f32,
    }
}

common::shader_struct! {
    /// Start of a walk.
    pub struct Trees {
        /// The nodes of all trees; node 0 is the root of the top tree.
        pub nodes: Address<Node>,
        /// The same nodes, quantised.
        pub packed: Address<Quantised>,
        /// The triangles of all meshes.
        pub corners: Address<Corners>,
        /// The instances.
        pub placed: Address<Placed>,
        /// The growth of the top tree's boxes, for a coordinate of 1.
        pub growth: f32,
        /// The largest coordinate of the world, without its sign.
        pub reach: f32,
    }
}

/// The shader that traces arbitrary rays, from a buffer to a buffer, for tests.
pub const RAYS: &str = "rays.comp";

/// The shaders by which the device itself traces them if it has no queries: raygen, miss, closest hit.
pub const TRACED: [&str; 3] = ["rays.rgen", "rays.rmiss", "rays.rchit"];

/// The trees of a scene on the device.
pub struct TreesOnGpu {
    /// The address of the [`Trees`].
    pub address: Address<Trees>,
    /// The order of each mesh's triangles, in the model's order of meshes.
    pub orders: Vec<Vec<u32>>,
    /// Maximum number of entries that a walk leaves behind.
    pub stack: u32,
    /// Bytes of all nodes, of all corners and of all instances.
    pub bytes: [usize; 3],
    _buffers: [Buffer; 2],
}

impl TreesOnGpu {
    /// Builds the trees of a scene and uploads them. An instance whose matrix cannot be inverted is
    /// left out: no ray meets what has no extent.
    ///
    /// # Errors
    /// If memory is short, a position takes more than 28 bits, or what the device built is not a tree.
    pub fn new(gpu: &Gpu, scene: &Scene, builder: Builder) -> Result<Self> {
        let meshes = &scene.model.meshes;
        let triangles: Vec<Vec<_>> = meshes.iter().map(corners_of).collect();
        let trees = builder.trees(gpu, meshes, &triangles)?;
        let bounds = scene.instances.iter().map(|instance| {
            let to_world = matrix(instance);
            let (low, high) = trees[instance.mesh].bounds();
            let is_there = low.x <= high.x && can_be_inverted(&to_world);
            if is_there { moved((low, high), &to_world) } else { NOWHERE }
        });
        let bounds: Vec<_> = bounds.collect();
        let top = builder.over_instances(&bounds);

        let mut nodes: Vec<_> = top.placed(0, 0).collect();
        let mut corners = Vec::new();
        let mut starts = Vec::new();
        for (triangles, tree) in triangles.iter().zip(&trees) {
            let start = (nodes.len() as u32, corners.len() as u32);
            nodes.extend(tree.placed(start.0, start.1));
            corners.extend(tree.order.iter().map(|&triangle| triangles[triangle as usize]));
            starts.push(start);
        }
        for (what, count) in
            [("nodes", nodes.len()), ("triangles", corners.len()), ("instances", bounds.len())]
        {
            ensure!(count < 1 << 28, "{count} {what} are too many: a position has 28 bits");
        }
        let mut growth = 0.0f64;
        let mut reach = 0.0f32;
        let placed = top.order.iter().map(|&number| {
            let instance = &scene.instances[number as usize];
            let (root, first) = starts[instance.mesh];
            let to_world = matrix(instance);
            let to_object = to_world.inverse();
            growth = growth.max(spread(&to_world, &to_object));
            reach = reach.max(largest(bounds[number as usize]));
            reach = reach.max(to_world.translation.abs().max_element() as f32);
            Placed {
                to_world: columns(&to_world),
                to_object: columns(&to_object),
                root,
                first,
                count: trees[instance.mesh].order.len() as u32,
                number,
                reach: largest(trees[instance.mesh].bounds()),
            }
        });
        let placed: Vec<_> = placed.collect();
        let bytes = [size_of_val(&nodes[..]), size_of_val(&corners[..]), size_of_val(&placed[..])];
        let packed = quantised(&nodes)?;
        let arrays: [&[u8]; 4] = [
            bytemuck::cast_slice(&nodes),
            bytemuck::cast_slice(&packed),
            bytemuck::cast_slice(&corners),
            bytemuck::cast_slice(&placed),
        ];
        let (buffer, at) = Buffer::with_arrays(gpu, "trees", arrays, Buffer::ADDRESSED)?;
        let head = Trees {
            nodes: at[0].into(),
            packed: at[1].into(),
            corners: at[2].into(),
            placed: at[3].into(),
            growth: (GROWTH * growth) as f32,
            reach,
        };
        let head = Buffer::with_data(gpu, "where the trees are", &[head], Buffer::ADDRESSED)?;
        let deepest =
            trees.iter().map(depth).try_fold(0, |most, depth| depth.map(|d| d.max(most)))?;
        Ok(Self {
            address: head.address.into(),
            orders: trees.into_iter().map(|tree| tree.order).collect(),
            // And the other instances of a leaf of the top tree, and the far child that is written before it counts.
            stack: depth(&top)? + 2 + deepest,
            bytes,
            _buffers: [buffer, head],
        })
    }
}

/// The corners of the triangles of a mesh.
fn corners_of(mesh: &Mesh) -> Vec<Corners> {
    let position = |at: u32| mesh.vertices[at as usize].position;
    let triangles = mesh.triangles.iter().map(|triangle| triangle.map(position));
    triangles.map(|[a, b, c]| Corners { a, b, c }).collect()
}

/// The largest coordinate of a box, without its sign.
fn largest((low, high): Bounds) -> f32 {
    low.abs().max(high.abs()).max_element()
}

/// The box around a box that a matrix has moved. What rounding takes from it, the growth of boxes gives back.
fn moved((low, high): Bounds, to_world: &DAffine3) -> Bounds {
    let (low, high) = (low.as_dvec3(), high.as_dvec3());
    let middle = to_world.transform_point3((low + high) * 0.5);
    let reach = to_world.matrix3.abs() * ((high - low) * 0.5);
    ((middle - reach).as_vec3(), (middle + reach).as_vec3())
}

/// The matrix of an instance, as it is: a product in 64 bits rounds nothing that matters here.
fn matrix(instance: &Instance) -> DAffine3 {
    let of = &instance.transform;
    let column = |v: common::glam::Vec3A| Vec3::from(v).as_dvec3();
    DAffine3::from_cols(
        column(of.matrix3.x_axis),
        column(of.matrix3.y_axis),
        column(of.matrix3.z_axis),
        column(of.translation),
    )
}

fn columns(matrix: &DAffine3) -> [Vec3; 4] {
    let of = &matrix.matrix3;
    [of.x_axis, of.y_axis, of.z_axis, matrix.translation].map(DVec3::as_vec3)
}

/// u = 2^-24, the most that a rounding is off.
const U: f64 = 1.0 / 16_777_216.0;

/// A ray is taken into a mesh's space by products that are off by less than 16u of their largest terms, and there
/// a box grows by 32u more.
const GROWTH: f64 = 64.0 * U;

/// By how much an error in a mesh's space, relative to the largest coordinate, is larger in the world: the
/// largest sum of a row of |L|·|W|, L the matrix, W its inverse. 1 where nothing is turned.
fn spread(to_world: &DAffine3, to_object: &DAffine3) -> f64 {
    let product = to_world.matrix3.abs() * to_object.matrix3.abs();
    let rows = product.transpose();
    [rows.x_axis, rows.y_axis, rows.z_axis].map(DVec3::element_sum).into_iter().fold(0.0, f64::max)
}

/// Tests whether the inverse is also one in 32 bits: where the matrix is singular except for rounding, no digit of
/// it is right.
fn can_be_inverted(to_world: &DAffine3) -> bool {
    let to_object = to_world.inverse();
    columns(&to_object).iter().all(|column| column.is_finite())
        && U * spread(to_world, &to_object) < 1.0
}
