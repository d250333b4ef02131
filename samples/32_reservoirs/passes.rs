//! The passes after the trace: reuse in time, and reuse in space.

use anyhow::Result;
use common::gpu::{Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, TextureTable, barrier};
use common::{Frame, Variant, Variants};

use super::lit_scene::LitScene;
use super::{Constants, Push};

common::shader_enum! {
    /// The quantity shown per pixel.
    pub enum Show: SHOW { Picture, Mean, Count, Emitter }
    /// The weight of a sample that several reservoirs could have made.
    pub enum Weights: WEIGHTS { OneOverM = "1/M", OneOverZ = "1/Z", Balance }
    /// The reservoirs that a pixel's own is merged with.
    pub enum Reuse { None, Time, Space, Both }
}

impl Reuse {
    /// Tests whether a pixel takes the last frame's reservoir.
    pub fn is_in_time(self) -> bool {
        matches!(self, Self::Time | Self::Both)
    }

    /// Tests whether a pixel takes its neighbours' reservoirs.
    pub fn is_in_space(self) -> bool {
        matches!(self, Self::Space | Self::Both)
    }
}

/// The pipelines of both passes.
#[derive(Default)]
pub struct Passes {
    time: Variants<Constants>,
    space: Variants<Constants>,
}

impl Passes {
    /// The names of the passes.
    pub const NAMES: [&str; 2] = ["time", "space"];

    /// Records a pass, and returns the constants of its pipeline: in a window, these may be those of the old controls.
    ///
    /// # Errors
    /// If its pipeline cannot be built.
    pub fn record(
        &mut self,
        frame: &Frame,
        number: u32,
        (lit, push, wanted): (&LitScene, &Push, Constants),
    ) -> Result<Constants> {
        let textures = &lit.on_gpu.textures;
        let tlas = Descriptor::AccelerationStructure(&lit.tlas);
        let picture = Descriptor::StorageImage(frame.image);
        // ANCHOR: passes
        // This pass reads the results of the one before.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        let Variant { pipeline, sbt, key } = if number == 0 {
            self.time.choose(frame, textures, wanted, time_pass)?
        } else {
            self.space.choose(frame, textures, wanted, space_pass)?
        };
        pipeline.bind(frame.cmd, &[tlas, picture], push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: passes
        Ok(*key)
    }
}

fn time_pass(gpu: &Gpu, _: &TextureTable, constants: Constants) -> Result<RayTracingPipeline> {
    pass("time.rgen", gpu, constants)
}

fn space_pass(gpu: &Gpu, _: &TextureTable, constants: Constants) -> Result<RayTracingPipeline> {
    pass("space.rgen", gpu, constants)
}

/// All its rays are shadow rays. They call miss shader 1, as those of the camera's pipeline do, and no hit shader.
fn pass(raygen: &str, gpu: &Gpu, constants: Constants) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen(raygen)
        .miss("common/shadow.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("hidden.rchit"))
        .hit(HitGroup::procedural("sphere.rint").closest_hit("hidden.rchit"))
        .constant(0, constants.show)
        .constant(2, constants.weights)
        .constant(3, constants.visibility)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .push_constants::<Push>()
        .build(gpu)
}
