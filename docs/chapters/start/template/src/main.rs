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
}

raybook::shader_struct! {
    /// Push constants of all shaders; `push.glsl` declares the same fields.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        sun: DirectionalLight,
        reflections: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let world = setup.scene_or(|| Scene::open(Path::new(SCENE)))?;
        let scene = SceneOnGpu::new(gpu, &world, setup.options)?;
        let pipeline = RayTracingPipeline::builder("my_tracer")
            .raygen("camera.rgen")
            .miss("common/sky.rmiss")
            .miss("common/shadow.rmiss")
            .hit(HitGroup::triangles().closest_hit("mesh.rchit"))
            .binding(Binding::AccelerationStructure)
            .binding(Binding::StorageImage)
            .textures(&scene.textures)
            .push_constants::<Push>()
            .build(gpu)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        let (camera, sun) = (world.camera, Sun::default());
        Ok(Self { scene, pipeline, sbt, camera, sun, reflections: 3 })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.integer("reflections", &mut self.reflections, 0..=8);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            sun: self.sun.light(),
            reflections: self.reflections,
        };
        let tlas = Descriptor::AccelerationStructure(&self.scene.tlas);
        let picture = Descriptor::StorageImage(frame.image);
        self.pipeline.bind(frame.cmd, &[tlas, picture], &push)?;
        self.sbt.trace(frame.cmd, frame.area);
        Ok(())
    }
}
