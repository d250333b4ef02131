//! Boxes around the ways of triangles: a compute shader computes them, for all that is under way at once.

use anyhow::Result;
use ash::vk;
use common::gpu::{Address, Buffer, ComputePipeline, Geometry, Gpu, barrier};
use common::scene::{InstanceRecord, input_usage};
use glam::Vec3;

use super::levels::Mover;

common::shader_struct! {
    /// A box, as a build reads it.
    struct Bounds {
        low: Vec3,
        high: Vec3,
    }
}

common::shader_struct! {
    /// Push constants of the compute shader.
    struct Sweeping {
        movers: Address<Mover>,
        instances: Address<InstanceRecord>,
        boxes: Address<Bounds>,
        /// Capacity of each, in boxes.
        room: u32,
        /// Margin of a box on each side.
        margin: f32,
    }
}

/// The boxes on the device, and what computes them.
pub struct Sweep {
    pub boxes: Buffer,
    room: u32,
    pipeline: ComputePipeline,
    gpu: Gpu,
}

impl Sweep {
    /// Room for so many triangles of each of so many pieces.
    pub fn new(gpu: &Gpu, room: u32, pieces: u32) -> Result<Self> {
        let boxes = vec![[Vec3::NEG_ONE, Vec3::ONE]; (room * pieces) as usize];
        let boxes = Buffer::with_data(gpu, "swept boxes", boxes.as_flattened(), input_usage())?;
        let pipeline = ComputePipeline::builder(env!("CARGO_BIN_NAME"))
            .compute("sweep.comp")
            .workgroup(0, [64, 1])
            .push_constants::<Sweeping>()
            .build_compute(gpu)?;
        Ok(Self { boxes, room, pipeline, gpu: gpu.clone() })
    }

    /// The geometry of a piece's bottom level.
    pub fn geometry(&self, piece: u32) -> Geometry {
        let offset = u64::from(piece * self.room) * size_of::<Bounds>() as u64;
        let boxes = self.boxes.address + offset;
        Geometry::Aabbs { boxes, count: self.room, opaque: true }
    }

    /// Records what computes the boxes of the first `pieces` for the builds that follow.
    pub fn record(
        &self,
        cmd: vk::CommandBuffer,
        (movers, instances): (Address<Mover>, Address<InstanceRecord>),
        pieces: u32,
        margin: f32,
    ) -> Result<()> {
        if pieces == 0 {
            return Ok(());
        }
        let boxes = self.boxes.address.into();
        let push = Sweeping { movers, instances, boxes, room: self.room, margin };
        let extent = vk::Extent2D { width: self.room, height: pieces };
        barrier::trace_to_deform(&self.gpu, cmd);
        self.pipeline.bind(cmd, &[], &push)?;
        self.pipeline.dispatch(cmd, vk::Rect2D { extent, ..Default::default() });
        barrier::deform_to_build(&self.gpu, cmd);
        Ok(())
    }
}
