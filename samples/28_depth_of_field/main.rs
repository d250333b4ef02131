//! 28 · Depth of field: rays start all over a lens, and what is not in the plane in focus is blurred.
//!
//! New since 37_sequences: the lens and its blades, a place on it for every ray, and a direction that
//! keeps its digits far from the origin.

mod lamps;
mod lens;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Binding, Buffer, Descriptor, Gpu, HitGroup, Image, Number, RayTracingPipeline, Requirements,
    TextureTable, barrier,
};
use common::scene::{Camera, CameraBasis, DirectionalLight, SceneAddresses, SceneOnGpu, Sun};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use lens::{Lens, ThinLens};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

/// Pieces in the tabulated inverse of a filter's CDF; `filter.glsl` has the same number.
const PIECES: usize = 1024;

struct Demo {
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    constants: Constants,
    lens: ThinLens,
    sequence: Sequence,
    scrambling: Scrambling,
    filter: Filter,
    seed: u32,
    accumulate: bool,
    means: Image,
    offsets: Buffer,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Normal, Triangle, Hit, Origin = "ray origin", Direction = "ray direction" }
    /// The sequence that places the rays in their pixels.
    enum Sequence: SEQUENCE { Centre, Random, Halton = "Halton", R2 = "R2", Sobol = "Sobol" }
    /// The scrambling that makes the pixels' sequences differ.
    enum Scrambling: SCRAMBLING { None, Rotation, Owen = "Owen" }
    /// The filter that weighs a pixel's neighbourhood.
    enum Filter: FILTER { Box, Tent, BlackmanHarris = "Blackman-Harris" }
    /// From where a ray's point in focus is seen when its direction is computed: from the world's origin,
    /// from the eye, or from where the ray starts.
    enum Rung: RUNG { World, Eye, Start }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    rung: Rung,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        lens: Lens,
        sequence: Number<Sequence>,
        scrambling: Number<Scrambling>,
        pixel_filter: Number<Filter>,
        seed: u32,
        frame: u32,
        accumulated: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let scene = setup.scene_or(lamps::chess)?;
        let camera = scene.camera;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        Ok(Self {
            scene,
            pipelines: Variants::default(),
            camera,
            sun: Sun::default(),
            constants: Constants { show: Show::Picture, rung: Rung::Start },
            lens: ThinLens::focused_on_target(&camera),
            sequence: Sequence::Sobol,
            scrambling: Scrambling::Owen,
            // Narrower than 37's default: what is in focus is sharper.
            filter: Filter::Tent,
            seed: 0,
            accumulate: true,
            means: Image::storage(gpu, "means", vk::Extent2D { width: 1, height: 1 })?,
            offsets: offsets(gpu)?,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        self.lens.controls(c);
        c.choice("rung", &mut self.constants.rung);
        c.choice("sequence", &mut self.sequence);
        c.choice("scrambling", &mut self.scrambling);
        c.choice("filter", &mut self.filter);
        c.integer("seed", &mut self.seed, 0..=1000);
        c.checkbox("accumulate", &mut self.accumulate);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        if self.means.extent != frame.image.extent {
            self.means = Image::storage(frame.gpu, "means", frame.image.extent)?;
        }
        // The previous frame may still write its means when this one begins to read them.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            lens: self.lens.shader(),
            sequence: self.sequence.into(),
            scrambling: self.scrambling.into(),
            pixel_filter: self.filter.into(),
            seed: self.seed,
            frame: frame.index,
            accumulated: if self.accumulates() { frame.accumulated } else { 0 },
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
            Descriptor::StorageImage(&self.means),
            Descriptor::StorageBuffer(&self.offsets),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }

    fn accumulates(&self) -> bool {
        // Data has no mean.
        let is_data = [Show::Hit, Show::Origin, Show::Direction].contains(&self.constants.show);
        self.accumulate && !is_data
    }
}

/// The pipeline for the shaders' constants.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.rung)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .binding(Binding::StorageImage)
        .binding(Binding::StorageBuffer)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}

/// The offsets, in pixels, below which a given part of the Blackman-Harris filter lies.
///
/// The filter is the window of Harris 1978 with four terms and a width of three pixels. Its integral is
/// a sum of sines with no inverse in closed form, so it is found by bisection, once, in f64.
fn offsets(gpu: &Gpu) -> Result<Buffer> {
    const WIDTH: f64 = 3.0;
    const TERMS: [f64; 4] = [0.35875, 0.48829, 0.14128, 0.01168];
    let below = |offset: f64| {
        let waves = (1..4).map(|k| {
            let turn = std::f64::consts::TAU * f64::from(k);
            TERMS[k as usize] / TERMS[0] * (turn * offset / WIDTH).sin() / turn
        });
        0.5 + offset / WIDTH + waves.sum::<f64>()
    };
    let inverse = |part: f64| {
        let (mut low, mut high) = (-WIDTH / 2.0, WIDTH / 2.0);
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = 0.5 * (low + high);
            if below(middle) < part { low = middle } else { high = middle }
        }
        high as f32
    };
    let offsets: Vec<f32> =
        (0..=PIECES).map(|piece| inverse(piece as f64 / PIECES as f64)).collect();
    Buffer::with_data(gpu, "offsets", &offsets, vk::BufferUsageFlags::STORAGE_BUFFER)
}
