//! 44 · Geometries: a bottom level of several geometries, each with its own hit records.
//!
//! New since 07_multi_closest_hit: meshes that stand in the same place share a bottom level, the geometry's index
//! leads shaders to its data and the device to its records, and the stride of the ray can be set wrong.

mod levels;
mod parts;

use std::ops::Range;
use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    AccelerationStructure, Binding, Descriptor, Gpu, HitGroup, Number, RayTracingPipeline, Record,
    Requirements, ShaderBindingTable, TextureTable, sbt,
};
use common::model::Model;
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Instance, Scene, SceneAddresses, SceneOptions, Sun,
};
use common::{Controls, Frame, Sample, Setup, bytemuck};
use glam::Vec3;
use levels::{Levels, LevelsOnGpu};
use parts::Cut;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Group, Record, Geometry,
    }
    /// The hit groups, in the order in which the pipeline gets them.
    enum Group: GROUP { Plain, Marble, Wood, Lacquer, Inspect }
}

/// Ray types: what a ray wants from the surface that it hits, its look or what there is to know.
/// Each instance has a record for each type; the numbers are also in `push.glsl`.
const RAY_TYPES: u32 = 2;
const LOOK: u32 = 0;
const INSPECT: u32 = 1;

struct Demo {
    whole: Scene,
    source: Source,
    scene: LevelsOnGpu,
    pipeline: RayTracingPipeline,
    sbt: ShaderBindingTable,
    camera: Camera,
    sun: Sun,
    show: Show,
    stride: u32,
    instance: u32,
    looks: Vec<Look>,
    written: Vec<Look>,
    wanted: Wanted,
    built: Wanted,
    options: SceneOptions,
    most: usize,
}

/// The settings that the levels are built from.
#[derive(Clone, Copy, PartialEq)]
struct Wanted {
    levels: Levels,
    cut: Cut,
    parts: u32,
}

/// A scene whose instances are in order of their places, and its hit records.
struct Source {
    scene: Scene,
    places: Vec<Range<usize>>,
    looks: Vec<Look>,
    records: Vec<Record>,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        show: Number<Show>,
        rows: u32,
        stride: u32,
    }
}

// ANCHOR: look
common::shader_struct! {
    /// The data of a record: what shaders read of it as `shaderRecordEXT`.
    #[derive(PartialEq)]
    struct Look {
        tint: Vec3,
        scale: f32,
        roughness: f32,
        record: u32,
    }
}
// ANCHOR_END: look

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let whole = setup.scene_or(Scene::chess)?;
        // A model of the reader's own has its parts already.
        let parts = if setup.scene().is_some() { 1 } else { 3 };
        let wanted = Wanted { levels: Levels::One, cut: Cut::Slices, parts };
        let most = levels::most_geometries(&gpu.limits);
        let source = Source::new(&whole, wanted, most);
        let scene = LevelsOnGpu::new(gpu, &source.scene, &source.places, setup.options, None)?;
        let pipeline = pipeline(gpu, &scene.textures)?;
        let sbt = ShaderBindingTable::with_hit_records(gpu, &pipeline, &source.records)?;
        Ok(Self {
            camera: whole.camera,
            whole,
            scene,
            pipeline,
            sbt,
            sun: Sun::default(),
            show: Show::Picture,
            stride: RAY_TYPES,
            instance: 0,
            written: source.looks.clone(),
            looks: source.looks.clone(),
            source,
            wanted,
            built: wanted,
            options: setup.options,
            most,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        let levels = c.choice("levels", &mut self.wanted.levels);
        let cut = c.choice("cut", &mut self.wanted.cut);
        let parts = c.integer("parts", &mut self.wanted.parts, 1..=64);
        c.needs("cut", "parts=2 or more", self.wanted.parts > 1);
        if levels || cut || parts {
            self.source = Source::new(&self.whole, self.wanted, self.most);
            self.looks.clone_from(&self.source.looks);
            self.instance = self.instance.min(self.looks.len() as u32 - 1);
        }
        c.integer("stride", &mut self.stride, 0..=RAY_TYPES);
        c.choice("show", &mut self.show);
        c.integer("instance", &mut self.instance, 0..=self.looks.len() as u32 - 1);
        let look = &mut self.looks[self.instance as usize];
        c.color("tint", &mut look.tint);
        c.slider("scale", &mut look.scale, 0.1..=10.0);
        c.slider("roughness", &mut look.roughness, 0.05..=1.0);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.built != self.wanted {
            let Source { scene, places, looks, records } = &self.source;
            let textures = Some(self.scene.textures.clone());
            self.scene = LevelsOnGpu::new(gpu, scene, places, self.options, textures)?;
            self.sbt = ShaderBindingTable::with_hit_records(gpu, &self.pipeline, records)?;
            self.written.clone_from(looks);
            self.built = self.wanted;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: write
        for (look, written) in self.looks.iter().zip(&mut self.written) {
            if look != written {
                let data = bytemuck::bytes_of(look);
                self.sbt.write_hit_data(frame.cmd, look.record as usize, data)?;
                *written = *look;
            }
        }
        // ANCHOR_END: write
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            show: self.show.into(),
            rows: frame.image.extent.height,
            stride: self.stride,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        self.pipeline.bind(frame.cmd, &descriptors, &push)?;
        self.sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }

    fn report(&self) -> Result<serde_json::Value> {
        let LevelsOnGpu { tlas, blas, .. } = &self.scene;
        let sum = |of: fn(&AccelerationStructure) -> u64| blas.iter().map(of).sum::<u64>();
        Ok(serde_json::json!({
            "table": self.source.table(),
            "levels": blas.len(),
            "instances": self.source.places.len(),
            "built_bytes": sum(AccelerationStructure::built_size),
            "bytes": sum(|level| level.size),
            "scratch_bytes": sum(AccelerationStructure::build_scratch),
            "top_bytes": tlas.size,
        }))
    }
}

impl Source {
    fn new(whole: &Scene, wanted: Wanted, most: usize) -> Self {
        let Wanted { levels, cut, parts } = wanted;
        let mut scene = if parts > 1 { parts::cut(whole, cut, parts) } else { whole.clone() };
        let most = if levels == Levels::Many { 1 } else { most };
        let places = levels::places(&mut scene.instances, most);
        // ANCHOR: records
        let mut looks = Vec::new();
        let mut records = Vec::new();
        for instance in &mut scene.instances {
            instance.record_offset = records.len() as u32;
            let (group, look) = look(&scene.model, instance);
            let data = bytemuck::bytes_of(&look).to_vec();
            records.push(Record { group: group as usize, data });
            records.push(Record { group: Group::Inspect as usize, data: Vec::new() });
            looks.push(look);
        }
        // ANCHOR_END: records
        Self { scene, places, looks, records }
    }

    /// The way from each geometry of each place to its records.
    fn table(&self) -> Vec<String> {
        let mut lines = vec!["instance offset + geometry × stride + ray type = record".to_owned()];
        let Scene { model, instances, .. } = &self.scene;
        for place in &self.places {
            let offset = instances[place.start].record_offset;
            for (geometry, instance) in (0..).zip(&instances[place.clone()]) {
                let mesh = &model.meshes[instance.mesh].name;
                let group = format!("{:?}", look(model, instance).0);
                let mut line = format!("{:>3} {mesh:<12} {group:<7}", place.start);
                for ray_type in [LOOK, INSPECT] {
                    let record = sbt::hit_record(offset, geometry, RAY_TYPES, ray_type);
                    line += &format!(
                        "  {offset:>3} + {geometry}×{RAY_TYPES} + {ray_type} = {record:>3}"
                    );
                }
                lines.push(line);
            }
        }
        lines
    }
}

/// The hit groups are numbered in this order.
fn pipeline(gpu: &Gpu, textures: &TextureTable) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::triangles().closest_hit("marble.rchit"))
        .hit(HitGroup::triangles().closest_hit("wood.rchit"))
        .hit(HitGroup::triangles().closest_hit("lacquer.rchit"))
        .hit(HitGroup::triangles().closest_hit("inspect.rchit"))
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .hit_data::<Look>()
        .build(gpu)
}

// ANCHOR: choose
/// The group that an instance takes, and the look that it starts with.
fn look(model: &Model, instance: &Instance) -> (Group, Look) {
    let mesh = model.meshes[instance.mesh].name.as_str();
    let material = &model.materials[instance.material];
    let (group, tint, roughness) = match (mesh, material.name.as_str()) {
        (_, "white") => (Group::Marble, Vec3::new(0.83, 0.78, 0.7), 0.25),
        (_, "inlay") => (Group::Lacquer, material.base_color, 0.2),
        (_, "black") | ("screen_frame", _) => (Group::Lacquer, Vec3::new(0.012, 0.009, 0.008), 0.2),
        ("board_light" | "board_dark" | "board_frame", _) => {
            (Group::Wood, material.base_color, 0.35)
        }
        _ => (Group::Plain, material.base_color, 0.5),
    };
    let record = sbt::hit_record(instance.record_offset, 0, RAY_TYPES, LOOK);
    (group, Look { tint, scale: 1.0, roughness, record })
}
// ANCHOR_END: choose
