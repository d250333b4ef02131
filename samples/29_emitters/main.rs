//! 29 · Emitters: luminous spheres and meshes are hit at random, sampled by shadow rays, or both.
//!
//! New since 11_path_tracing: directions to what shines, chosen within the solid angle that it fills; a table
//! that chooses one of many; and the balance of two ways to find the same light.

mod alias;
#[path = "../11_path_tracing/closed_forms.rs"]
mod closed_forms;
mod emitters;
mod lit_scene;
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable, barrier,
};
use common::scene::{Camera, CameraBasis, Look, SceneAddresses, input_usage};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use emitters::EmitterAddresses;
use glam::UVec3;
use lit_scene::LitScene;
use scenes::{SceneName, Sky, Staged};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

/// Maximum number of reflections.
const MAX_DEPTH: u32 = 256;

struct Demo {
    source: Staged,
    staged: Staged,
    lit: LitScene,
    pipelines: Variants<Constants>,
    camera: Camera,
    name: SceneName,
    /// The scene that was built.
    built: SceneName,
    depth: u32,
    clamp: f32,
    seed: u32,
    constants: Constants,
    sums: Buffer,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Rays }
    /// The rays that find the light of an emitter: those of the path, shadow rays, or both.
    enum Estimator: ESTIMATOR { Bsdf = "BSDF", Light, Mis = "MIS" }
    /// The emitters that shadow rays sample.
    enum Choice: CHOICE { One, All, Power = "by power" }
    /// The distribution of points on a triangle.
    enum Triangles: TRIANGLES { Area, SolidAngle }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    sky: Sky,
    estimator: Estimator,
    choice: Choice,
    triangles: Triangles,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        emitters: Address<EmitterAddresses>,
        sums: Address<PixelSum>,
        depth: u32,
        most: f32,
        seed: u32,
        sample_index: u32,
    }
}

common::shader_struct! {
    /// The samples of a pixel, added up.
    struct PixelSum {
        whole: UVec3,
        part: UVec3,
        count: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let source = match setup.scene() {
            Some(_) => Staged::from_file(
                setup.scene_with(&[Look::Mirror], || unreachable!("there is a file"))?,
            ),
            None => scenes::chess()?,
        };
        let staged = Staged::new(SceneName::Chess, &source);
        let camera = staged.scene.camera;
        let lit = LitScene::new(gpu, &staged, setup.options, camera.eye.as_vec3())?;
        Ok(Self {
            source,
            constants: Constants {
                show: Show::Picture,
                sky: staged.sky,
                estimator: Estimator::Mis,
                choice: Choice::Power,
                triangles: Triangles::SolidAngle,
            },
            staged,
            lit,
            pipelines: Variants::default(),
            camera,
            name: SceneName::Chess,
            built: SceneName::Chess,
            depth: 16,
            clamp: 0.0,
            seed: 0,
            sums: Buffer::new(gpu, "sums", 0, input_usage())?,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.name) {
            let Staged { scene, sky, .. } = Staged::new(self.name, &self.source);
            (self.camera, self.constants.sky) = (scene.camera, sky);
        }
        c.choice("show", &mut self.constants.show);
        c.choice("sky", &mut self.constants.sky);
        c.choice("estimator", &mut self.constants.estimator);
        c.choice("emitters", &mut self.constants.choice);
        c.choice("triangles", &mut self.constants.triangles);
        c.integer("depth", &mut self.depth, 0..=MAX_DEPTH);
        c.slider("clamp", &mut self.clamp, 0.0..=100.0);
        c.integer("seed", &mut self.seed, 0..=1000);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        let eye = self.camera.eye.as_vec3();
        if self.name != self.built {
            self.staged = Staged::new(self.name, &self.source);
            self.built = self.name;
            self.lit.rebuild(gpu, &self.staged, eye)?;
        } else if self.lit.is_outdated(&self.staged, eye) {
            self.lit.rebuild(gpu, &self.staged, eye)?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let extent = frame.image.extent;
        let size =
            u64::from(extent.width) * u64::from(extent.height) * size_of::<PixelSum>() as u64;
        if self.sums.size != size {
            let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
            self.sums = Buffer::new(frame.gpu, "sums", size, usage)?;
        }
        if frame.accumulated == 0 && frame.is_first_band() {
            self.sums.clear(frame.cmd);
        }
        // The previous frame may still write its sums when this one begins to read them.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.lit.on_gpu.addresses,
            emitters: self.lit.emitters.address.into(),
            sums: self.sums.address.into(),
            depth: self.depth,
            most: self.clamp,
            seed: self.seed,
            sample_index: frame.index,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.lit.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let textures = &self.lit.on_gpu.textures;
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }

    fn accumulates(&self) -> bool {
        true
    }
}

/// Raygen traces every ray of a path: however long that is, rays do not nest.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::procedural("sphere.rint").closest_hit("sphere.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.sky)
        .constant(2, constants.estimator)
        .constant(3, constants.choice)
        .constant(4, constants.triangles)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
