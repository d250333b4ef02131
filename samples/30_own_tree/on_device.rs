//! A tree built on the device, by compute shaders alone and without the host in between: triangles are sorted by the
//! Morton codes of their centres, and the sorted codes say which node lies above which.

use anyhow::{Result, ensure};
use ash::vk;
use common::gpu::{ComputePipeline, Gpu, ShaderStruct, barrier};

use crate::device_tree::{Bounds, DeviceTree, Scratch};
use crate::pushes::{Code, Fit, Hierarchy, Leaves, Level, Reduce, Sort};

/// The folder of the shaders.
const NAME: &str = "30_own_tree";
/// Invocations of a workgroup.
const WIDTH: u32 = 64;
/// The same where keys are sorted: one for each bit of a word.
const SORT_WIDTH: u32 = 32;
/// Values of the ten bits that a step of the sort goes by: three steps for the 30 bits of a key.
pub(crate) const DIGITS: u32 = 1024;
const BITS: u32 = DIGITS.trailing_zeros();
/// Least number of keys that a workgroup sorts, and the maximum number of workgroups: each keeps a count of every
/// digit.
const LEAST_SHARE: u32 = 2048;
pub(crate) const MOST_SHARES: u32 = 512;
/// Number of workgroups that find the extent of all triangles.
pub(crate) const EXTENT_SHARES: u32 = 128;
/// Number of workgroups that any device takes in a row.
const ROW: u32 = 65_535;

/// Triangles on the device.
#[derive(Clone, Copy)]
pub struct Triangles {
    /// Address of the first [`Vertex`](common::scene::Vertex).
    pub vertices: vk::DeviceAddress,
    /// Address of the first triangle's three `u32`, each a vertex's position.
    pub triangles: vk::DeviceAddress,
    /// Number of triangles.
    pub count: u32,
}

/// Builds trees of triangles.
pub struct DeviceBuilder {
    extent: ComputePipeline,
    morton: ComputePipeline,
    count: ComputePipeline,
    scan: ComputePipeline,
    scatter: ComputePipeline,
    hierarchy: ComputePipeline,
    leaves: ComputePipeline,
    pyramid: ComputePipeline,
    fit: ComputePipeline,
    gpu: Gpu,
}

impl DeviceBuilder {
    /// Compiles the shaders of all passes.
    ///
    /// # Errors
    /// If one does not compile.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        Ok(Self {
            extent: pipeline::<Reduce>(gpu, "extent.comp")?,
            morton: pipeline::<Code>(gpu, "morton.comp")?,
            count: pipeline::<Sort>(gpu, "count.comp")?,
            scan: pipeline::<Sort>(gpu, "scan.comp")?,
            scatter: pipeline::<Sort>(gpu, "scatter.comp")?,
            hierarchy: pipeline::<Hierarchy>(gpu, "hierarchy.comp")?,
            leaves: pipeline::<Leaves>(gpu, "leaves.comp")?,
            pyramid: pipeline::<Level>(gpu, "pyramid.comp")?,
            fit: pipeline::<Fit>(gpu, "fit.comp")?,
            gpu: gpu.clone(),
        })
    }

    /// Records that `tree` becomes one over `triangles`, for the compute shaders that follow in `cmd`. Earlier ones
    /// may have read the tree, and moved the triangles.
    ///
    /// A triangle with a corner that is not finite is left out: no leaf counts on its position, which lies behind
    /// all others.
    ///
    /// # Errors
    /// If the tree is for another number of triangles, or the scratch memory for fewer.
    pub fn record(
        &self,
        cmd: vk::CommandBuffer,
        triangles: Triangles,
        tree: &DeviceTree,
        scratch: &Scratch,
    ) -> Result<()> {
        check(triangles, tree, scratch)?;
        self.sort(cmd, triangles, tree, scratch)?;
        let nodes_count = tree.nodes_count();
        let push = Hierarchy {
            keys: scratch.keys[1],
            extents: scratch.extents,
            nodes: tree.nodes.address.into(),
            ends: tree.ends.address.into(),
            nodes_count,
        };
        self.each(cmd, &self.hierarchy, &push, nodes_count)?;
        self.refit(cmd, triangles, tree, scratch)
    }

    /// Records that the boxes and corners of a built tree are those of triangles that have moved. Which node lies
    /// above which stays, and with it which triangles were left out; a triangle whose corners are no longer finite
    /// has a box that no ray meets.
    ///
    /// # Errors
    /// As [`DeviceBuilder::record`].
    pub fn refit(
        &self,
        cmd: vk::CommandBuffer,
        Triangles { vertices, triangles, count }: Triangles,
        tree: &DeviceTree,
        scratch: &Scratch,
    ) -> Result<()> {
        check(Triangles { vertices, triangles, count }, tree, scratch)?;
        let (original, corners) = (tree.original.address.into(), tree.corners.address.into());
        let (vertices, triangles, boxes) = (vertices.into(), triangles.into(), scratch.boxes);
        let leaves = Leaves { vertices, triangles, original, corners, boxes, count };
        self.each(cmd, &self.leaves, &leaves, count)?;
        let (mut level, mut boxes_left) = (scratch.boxes, count);
        while boxes_left > 1 {
            let push = Level { boxes: level, count: boxes_left };
            self.each(cmd, &self.pyramid, &push, boxes_left.div_ceil(8))?;
            // As many levels as one dispatch makes.
            for _ in 0..3 {
                let next = vk::DeviceAddress::from(level) + bytes::<Bounds>(boxes_left);
                (level, boxes_left) = (next.into(), boxes_left.div_ceil(2));
            }
        }
        let (nodes, ends) = (tree.nodes.address.into(), tree.ends.address.into());
        let nodes_count = tree.nodes_count();
        let fit = Fit { nodes, ends, boxes: scratch.boxes, nodes_count, count };
        self.each(cmd, &self.fit, &fit, nodes_count)?;
        barrier::pass_to_pass(&self.gpu, cmd);
        Ok(())
    }

    /// Records that positions get their triangles.
    fn sort(
        &self,
        cmd: vk::CommandBuffer,
        Triangles { vertices, triangles, count }: Triangles,
        tree: &DeviceTree,
        scratch: &Scratch,
    ) -> Result<()> {
        let (vertices, triangles, extents) = (vertices.into(), triangles.into(), scratch.extents);
        let shares = count.div_ceil(LEAST_SHARE).clamp(1, EXTENT_SHARES);
        let reduce = Reduce { vertices, triangles, extents, count, shares, is_last: 0 };
        self.pass(cmd, &self.extent, &reduce, shares)?;
        self.pass(cmd, &self.extent, &Reduce { is_last: 1, ..reduce }, 1)?;
        let [keys, other_keys] = scratch.keys;
        let (values, original) = (scratch.values, tree.original.address.into());
        let code = Code { vertices, triangles, extents, keys, values, count };
        self.each(cmd, &self.morton, &code, count)?;
        // A whole number of workgroups' rounds.
        let share_length =
            count.div_ceil(MOST_SHARES).max(LEAST_SHARE).next_multiple_of(2 * SORT_WIDTH);
        let shares = count.div_ceil(share_length);
        // To and fro, so that the third of three steps ends where the values are wanted.
        let (mut from, mut to) = ((keys, values), (other_keys, original));
        for step in 0..3 {
            let push = Sort {
                keys: from.0,
                values: from.1,
                sorted_keys: to.0,
                sorted_values: to.1,
                counts: scratch.counts,
                totals: scratch.totals,
                count,
                share_length,
                shares,
                shift: step * BITS,
            };
            self.pass(cmd, &self.count, &push, shares)?;
            self.pass(cmd, &self.scan, &push, DIGITS / SORT_WIDTH)?;
            self.pass(cmd, &self.scatter, &push, shares)?;
            (from, to) = (to, from);
        }
        Ok(())
    }

    /// Records a pass with an invocation for each of `count` things.
    fn each<T: ShaderStruct>(
        &self,
        cmd: vk::CommandBuffer,
        pipeline: &ComputePipeline,
        push: &T,
        count: u32,
    ) -> Result<()> {
        self.pass(cmd, pipeline, push, count.div_ceil(WIDTH))
    }

    /// Records a pass, which sees what the passes before it wrote.
    fn pass<T: ShaderStruct>(
        &self,
        cmd: vk::CommandBuffer,
        pipeline: &ComputePipeline,
        push: &T,
        workgroups: u32,
    ) -> Result<()> {
        barrier::pass_to_pass(&self.gpu, cmd);
        pipeline.bind(cmd, &[], push)?;
        let across = workgroups.clamp(1, ROW);
        // SAFETY: cmd is being recorded on this device, and the pipeline outlives the submission.
        unsafe { self.gpu.device.cmd_dispatch(cmd, across, workgroups.div_ceil(across), 1) };
        Ok(())
    }
}

fn check(triangles: Triangles, tree: &DeviceTree, scratch: &Scratch) -> Result<()> {
    ensure!(
        triangles.count == tree.count,
        "a tree of {} triangles cannot be built from {}",
        tree.count,
        triangles.count
    );
    ensure!(
        tree.count <= scratch.most,
        "scratch memory for {} triangles is too small for a tree of {}",
        scratch.most,
        tree.count
    );
    Ok(())
}

/// Bytes of a row.
pub(crate) fn bytes<T>(count: u32) -> u64 {
    size_of::<T>() as u64 * u64::from(count)
}

fn pipeline<Push: ShaderStruct>(gpu: &Gpu, shader: &str) -> Result<ComputePipeline> {
    let builder = ComputePipeline::builder(NAME).compute(shader).push_constants::<Push>();
    builder.build_compute(gpu)
}
