//! A scene in the sun, with a mirror.

use std::path::Path;
use std::process::ExitCode;

use raybook::prelude::*;

/// The scene, unless `--scene` names another file.
const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scene.obj");

fn main() -> ExitCode {
    raybook::run!(Demo)
}

struct Demo {
    scene: SceneOnGpu,
    pipeline: RayTracingPipeline,
    sbt: ShaderBindingTable,
    camera: Camera,
    sun: Sun,
    reflections: u32,
    moon: f32,
    radius: f32,
}

raybook::shader_struct! {
    /// Push constants of all shaders; `push.glsl` declares the same fields.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        sun: DirectionalLight,
        reflections: u32,
        moon: f32,
        radius: f32,
        center: Vec3,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let world = setup.scene_or(|| Scene::open(Path::new(SCENE)))?;
        let mut scene = SceneOnGpu::new(gpu, &world, setup.options)?;
        // A box that holds the largest sphere, and a little more.
        let bounds = [Vec3::new(0.1, -0.1, 0.1), Vec3::new(1.7, 1.5, 1.7)];
        let boxes = boxes_on_gpu(gpu, "sphere", &[bounds])?;
        let shape = [Geometry::Aabbs { boxes: boxes.address, count: 1, opaque: true }];
        let sphere = AccelerationStructure::bottom(gpu, "sphere", &shape, BuildOptions::default())?;
        // A new top level: the meshes use hit record 0, and the sphere hit record 1.
        let meshes = world.instances.iter().enumerate();
        let meshes =
            meshes.map(|(i, at)| instance_on_gpu(&at.transform, i, 0, &scene.blas[at.mesh]));
        // The custom index is that of the last mesh, whose material the sphere borrows.
        let last = world.instances.len() - 1;
        let sphere_instance = instance_on_gpu(&Affine3A::IDENTITY, last, 1, &sphere);
        scene.tlas = build_top(gpu, &meshes.chain([sphere_instance]).collect::<Vec<_>>())?;
        let pipeline = RayTracingPipeline::builder("my_tracer")
            .raygen("camera.rgen")
            .miss("common/sky.rmiss")
            .miss("common/shadow.rmiss")
            .hit(HitGroup::triangles().closest_hit("mesh.rchit"))
            .hit(HitGroup::procedural("sphere.rint").closest_hit("sphere.rchit"))
            .binding(Binding::AccelerationStructure)
            .binding(Binding::StorageImage)
            .textures(&scene.textures)
            .push_constants::<Push>()
            .build(gpu)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        let (camera, sun) = (world.camera, Sun::default());
        Ok(Self { scene, pipeline, sbt, camera, sun, reflections: 3, moon: 1.0, radius: 0.6 })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.integer("reflections", &mut self.reflections, 0..=8);
        c.sun(&mut self.sun);
        c.slider("radius", &mut self.radius, 0.1..=0.7);
        c.slider("moon", &mut self.moon, 0.0..=3.0);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            sun: self.sun.light(),
            reflections: self.reflections,
            moon: self.moon,
            radius: self.radius,
            center: Vec3::new(0.9, self.radius, 0.9),
        };
        let tlas = Descriptor::AccelerationStructure(&self.scene.tlas);
        let picture = Descriptor::StorageImage(frame.image);
        self.pipeline.bind(frame.cmd, &[tlas, picture], &push)?;
        self.sbt.trace(frame.cmd, frame.area);
        Ok(())
    }
}
