//! A sphere on a ground, lit by the sun.

use std::path::Path;
use std::process::ExitCode;

use raybook::prelude::*;

/// The scene, unless `--scene` names another file.
const GROUND: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/ground.obj");

fn main() -> ExitCode {
    raybook::run!(Demo)
}

struct Demo {
    scene: SceneOnGpu,
    /// The top level points to it, so it must live as long.
    _sphere: AccelerationStructure,
    tlas: AccelerationStructure,
    pipeline: RayTracingPipeline,
    sbt: ShaderBindingTable,
    camera: Camera,
    sun: Sun,
    radius: f32,
}

raybook::shader_struct! {
    /// The data that every shader can read; `push.glsl` declares the same.
    struct Push { camera: CameraBasis, scene: SceneAddresses, light: DirectionalLight, radius: f32 }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let world = setup.scene_or(|| Scene::open(Path::new(GROUND)))?;
        let scene = SceneOnGpu::new(gpu, &world, setup.options)?;
        // A little larger than the largest sphere.
        let bounds = [Vec3::new(-1.1, -0.1, -1.1), Vec3::new(1.1, 2.1, 1.1)];
        let boxes = boxes_on_gpu(gpu, "sphere", &[bounds])?;
        let shape = [Geometry::Aabbs { boxes: boxes.address, count: 1, opaque: true }];
        let sphere = AccelerationStructure::bottom(gpu, "sphere", &shape, BuildOptions::default())?;
        // The scene's own top level has no ball. This one has both.
        // Meshes use hit record 0, and the sphere 1: the order of the hit groups below.
        let meshes = world.instances.iter().enumerate();
        let meshes =
            meshes.map(|(i, at)| instance_on_gpu(&at.transform, i, 0, &scene.blas[at.mesh]));
        let ball = instance_on_gpu(&Affine3A::IDENTITY, 0, 1, &sphere);
        let tlas = build_top(gpu, &meshes.chain([ball]).collect::<Vec<_>>())?;
        let pipeline = pipeline(gpu, &scene.textures)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        let (camera, sun, radius) = (world.camera, Sun::default(), 1.0);
        Ok(Self { scene, _sphere: sphere, tlas, pipeline, sbt, camera, sun, radius })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.slider("radius", &mut self.radius, 0.1..=1.0);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            radius: self.radius,
        };
        let tlas = Descriptor::AccelerationStructure(&self.tlas);
        let picture = Descriptor::StorageImage(frame.image);
        self.pipeline.bind(frame.cmd, &[tlas, picture], &push)?;
        self.sbt.trace(frame.cmd, frame.area);
        Ok(())
    }
}

fn pipeline(gpu: &Gpu, textures: &TextureTable) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .hit(HitGroup::triangles().closest_hit("mesh.rchit"))
        .hit(HitGroup::procedural("sphere.rint").closest_hit("sphere.rchit"))
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
