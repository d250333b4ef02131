//! 30 · Own tree: the picture of 16 without an acceleration structure, by a tree that is built and walked here.
//!
//! New since 16_ray_query: a tree of boxes for each mesh and one over the instances, in place of the
//! acceleration structures; a walk through both, in place of the query; how boxes and triangles are tested is
//! a choice. No ray tracing extension is asked for.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Band, Binding, ComputePipeline, Descriptor, Gpu, Requirements, TextureTable,
};
use common::scene::{Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, Sun};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::{Vec2, Vec3};
use own_tree::{Builder, OwnScene, Trees};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    scene: OwnScene,
    builder: Builder,
    built_by: Builder,
    pipelines: Variants<Constants, ComputePipeline>,
    camera: Camera,
    sun: Sun,
    constants: Constants,
    view: View,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
        Steps, Depth, Boxes, Walk,
    }
}

common::shader_enum! {
    /// The test of a ray against a box.
    enum Boxes: BOXES { Bare, Guess, Ize, Bound, TwoFloat = "two-float" }
}

common::shader_enum! {
    /// The test of a ray against a triangle.
    enum Triangles: TRIANGLES { Moeller, Watertight, TwoFloat = "two-float" }
}

common::shader_enum! {
    /// Size of a node in bytes.
    enum Nodes { Floats = "64 bytes", Quantised = "36 bytes" }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    boxes: Boxes,
    triangles: Triangles,
    nodes: Nodes,
    /// Capacity of the stack, in entries.
    stack: u32,
}

common::shader_struct! {
    /// Parameters of a view.
    struct View {
        /// The pixel whose ray is walked: parts of the picture's sides.
        pixel: Vec2,
        /// After how many nodes.
        step: u32,
        /// The boxes with a longest side from this size to twice as much.
        size: f32,
    }
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        trees: Address<Trees>,
        view: View,
        band: Band,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::compute().textures().int64_where_offered()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let source = setup.scene_or(Scene::chess)?;
        let camera = source.camera;
        let builder = Builder::Reinserted;
        let scene = OwnScene::new(gpu, &source, builder)?;
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        let constants = Constants {
            show: Show::Picture,
            boxes: Boxes::Bound,
            triangles: Triangles::Watertight,
            nodes: Nodes::Floats,
            stack: scene.trees.stack,
        };
        let view = View { pixel: Vec2::splat(0.5), step: 20, size: 0.25 };
        Ok(Self {
            source,
            scene,
            builder,
            built_by: builder,
            pipelines: Variants::default(),
            camera,
            sun,
            constants,
            view,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.choice("tree", &mut self.builder);
        c.choice("nodes", &mut self.constants.nodes);
        c.choice("boxes", &mut self.constants.boxes);
        c.choice("triangles", &mut self.constants.triangles);
        c.slider("box size", &mut self.view.size, 0.01..=10.0);
        c.slider("walk x", &mut self.view.pixel.x, 0.0..=1.0);
        c.slider("walk y", &mut self.view.pixel.y, 0.0..=1.0);
        c.integer("walk step", &mut self.view.step, 1..=200);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.builder != self.built_by {
            self.scene.rebuild(gpu, &self.source, self.builder)?;
            self.built_by = self.builder;
            self.constants.stack = self.scene.trees.stack;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            trees: self.scene.trees.address,
            view: self.view,
            band: frame.area.into(),
        };
        let descriptors = [Descriptor::StorageImage(frame.image)];
        let Variant { pipeline, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        pipeline.dispatch(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

/// One stage, and a stack deep enough for these trees.
fn pipeline(gpu: &Gpu, textures: &TextureTable, constants: Constants) -> Result<ComputePipeline> {
    ComputePipeline::builder(env!("CARGO_BIN_NAME"))
        .compute("trace.comp")
        .workgroup(4, [8, 4])
        .constant(0, constants.show)
        .constant(1, constants.boxes)
        .constant(2, constants.triangles)
        .constant(3, constants.stack)
        .constant(6, constants.nodes)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .rounding_to_nearest_even(gpu)
        .int64(gpu)
        .build_compute(gpu)
}
