//! 07 · Multi closest hit: each instance has its own hit groups, and each record its own data.
//!
//! New since 02_basic: several hit groups, two records for each instance, of which the ray takes one,
//! and data in a record that changes at run time while the pipeline stays.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, Number, RayTracingPipeline, Record, Requirements,
    ShaderBindingTable, ShaderStruct, TextureTable,
    sbt::{self, Region},
};
use common::model::Model;
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Instance, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup, bytemuck};
use glam::Vec3;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Normal, Triangle, Hit, Direction = "ray direction", Group, Record }
    /// The hit groups, in the order in which the pipeline gets them.
    enum Group: GROUP { Plain, Marble, Wood, Lacquer, Inspect }
}

/// Ray types: what a ray wants from the surface that it hits, its look or what there is to know.
/// Each instance has a record for each type; the numbers are also in `push.glsl`.
const RAY_TYPES: u32 = 2;
const LOOK: u32 = 0;
const INSPECT: u32 = 1;

struct Demo {
    scene: SceneOnGpu,
    pipeline: RayTracingPipeline,
    sbt: ShaderBindingTable,
    camera: Camera,
    sun: Sun,
    show: Show,
    instance: u32,
    looks: Vec<Look>,
    written: Vec<Look>,
    table: Vec<String>,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        show: Number<Show>,
        rows: u32,
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
        let mut source = setup.scene_or(Scene::chess)?;
        // ANCHOR: records
        let mut looks = Vec::new();
        let mut records = Vec::new();
        for instance in &mut source.instances {
            instance.record_offset = records.len() as u32;
            let (group, look) = look(&source.model, instance);
            let data = bytemuck::bytes_of(&look).to_vec();
            records.push(Record { group: group as usize, data });
            records.push(Record { group: Group::Inspect as usize, data: Vec::new() });
            looks.push(look);
        }
        // ANCHOR_END: records
        let camera = source.camera;
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        let pipeline = pipeline(gpu, &scene.textures)?;
        let sbt = ShaderBindingTable::with_hit_records(gpu, &pipeline, &records)?;
        Ok(Self {
            table: table(gpu, &sbt, &source),
            scene,
            pipeline,
            sbt,
            camera,
            sun: Sun::default(),
            show: Show::Picture,
            instance: 0,
            written: looks.clone(),
            looks,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.show);
        c.integer("instance", &mut self.instance, 0..=self.looks.len() as u32 - 1);
        let look = &mut self.looks[self.instance as usize];
        c.color("tint", &mut look.tint);
        c.slider("scale", &mut look.scale, 0.1..=10.0);
        c.slider("roughness", &mut look.roughness, 0.05..=1.0);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
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
        let address = self.sbt.regions[0].device_address;
        Ok(serde_json::json!({ "address": address, "table": self.table }))
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
        (_, "black") | ("screen_frame", _) => (Group::Lacquer, Vec3::new(0.012, 0.009, 0.008), 0.2),
        ("board_light" | "board_dark" | "board_frame", _) => {
            (Group::Wood, material.base_color, 0.35)
        }
        _ => (Group::Plain, Vec3::ONE, 0.5),
    };
    let record = sbt::hit_record(instance.record_offset, 0, RAY_TYPES, LOOK);
    (group, Look { tint, scale: 1.0, roughness, record })
}
// ANCHOR_END: choose

/// The table as it lies in memory, and the way from each instance to its records.
fn table(gpu: &Gpu, sbt: &ShaderBindingTable, scene: &Scene) -> Vec<String> {
    let handle = gpu.limits.shader_group_handle_size as usize;
    let alignment = gpu.limits.shader_group_handle_alignment;
    let base = gpu.limits.shader_group_base_alignment;
    let mut lines = vec![
        format!("handle {handle} bytes, stride a multiple of {alignment}, region at one of {base}"),
        "region      offset  stride  records".to_owned(),
    ];
    for (name, region) in ["raygen", "miss", "hit", "callable"].iter().zip(&sbt.layout.regions) {
        let Region { offset, stride, size } = region;
        let records = size.checked_div(*stride).unwrap_or(0);
        lines.push(format!("{name:<10} {offset:>7} {stride:>7} {records:>8}"));
    }
    let hit = sbt.layout.regions[2];
    let fields = Look::LAYOUT.fields.iter().map(|(name, at, _)| format!("{} {name}", handle + at));
    let fields = fields.collect::<Vec<_>>().join(", ");
    let (end, stride) = (handle + Look::LAYOUT.size, hit.stride);
    lines.push(format!("hit record: 0 handle, {fields}, {end} nothing, {stride} the next"));
    lines.push("instance offset + geometry × stride + ray type = record, at its byte".to_owned());
    for (index, instance) in scene.instances.iter().enumerate() {
        let (mesh, offset) = (&scene.model.meshes[instance.mesh].name, instance.record_offset);
        let group = format!("{:?}", look(&scene.model, instance).0);
        let mut line = format!("{index:>3} {mesh:<12} {group:<7}");
        for ray_type in [LOOK, INSPECT] {
            let record = sbt::hit_record(offset, 0, RAY_TYPES, ray_type);
            let byte = hit.offset + u64::from(record) * hit.stride;
            line +=
                &format!("  {offset:>2} + 0×{RAY_TYPES} + {ray_type} = {record:>2} at {byte:>4}");
        }
        lines.push(line);
    }
    lines
}
