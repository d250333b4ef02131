//! Known faults of drivers: traces rays under the circumstances in which each was reported, and counts those that
//! show it.

use std::path::Path;

use anyhow::{Result, ensure};
use ash::vk;
use common::files::write_whole;
use common::gpu::{
    AccelerationStructure, Address, Binding, Buffer, BuildOptions, Descriptor, Geometry, Gpu,
    HitGroup, RayTracingPipeline, ShaderBindingTable, barrier,
};
use common::output;
use common::scene::{boxes_on_gpu, build_top, input_usage};
use glam::Vec3;
use serde::Serialize;

use crate::batch::{IDENTITY, instance};

/// Boxes, in a cube of so many along each side.
const SIDE: usize = 16;
/// Rays of a launch's row.
const WIDTH: u32 = 64;
/// The primitive of a ray that hit nothing, as in faults.glsl.
const NOTHING: u32 = u32::MAX;
/// The bits of [`Seen::wrong`] and the shaders they belong to, as in faults.glsl.
const WRONG: [(u32, &str); 4] = [
    (1, "in an any-hit shader"),
    (2, "in a closest hit shader"),
    (4, "after a trace in a closest hit shader"),
    (8, "of a nested ray"),
];

common::shader_struct! {
    struct Aim {
        origin: Vec3,
        wanted: u32,
        direction: Vec3,
    }
}

common::shader_struct! {
    struct Seen {
        primitive: u32,
        wrong: u32,
        nested: u32,
    }
}

common::shader_struct! {
    struct Push {
        aims: Address<Aim>,
        results: Address<Seen>,
        count: u32,
    }
}

/// A fault, and whether this device has it.
#[derive(Serialize)]
struct Row {
    /// The circumstances.
    what: &'static str,
    /// The number of rays.
    rays: usize,
    /// The number of rays that show the fault.
    wrong: usize,
    /// Where it showed; empty if it did not.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    places: Vec<String>,
}

/// Looks for every fault and prints a line for each; writes the rows to `report`, if there is one.
///
/// `risky` instead looks for the one that may hang a machine.
///
/// # Errors
/// If the device fails, or has one of the faults.
pub fn run(gpu: &Gpu, risky: bool, report: Option<&Path>) -> Result<()> {
    let rows = if risky {
        vec![empty_top_level(gpu, &[])?, empty_top_level(gpu, &[instance(&IDENTITY, 0, 0)])?]
    } else {
        let [before, after] = [0, 1].map(boxes);
        vec![
            lost("boxes as they were built (to compare with)", gpu, &before, None)?,
            lost("boxes after an update", gpu, &before, Some(&after))?,
            wrong_attributes(gpu, &before)?,
        ]
    };
    let text: String = rows.iter().map(|row| row.line() + "\n").collect();
    let json = || Ok::<_, serde_json::Error>(serde_json::to_string_pretty(&rows)? + "\n");
    match report {
        Some(path) if path == Path::new("-") => output::print(&json()?)?,
        Some(path) => {
            write_whole(path, json()?.as_bytes())?;
            output::print(&text)?;
        }
        None => output::print(&text)?,
    }
    let faulty: Vec<String> = rows.iter().filter(|row| row.wrong > 0).map(Row::line).collect();
    ensure!(faulty.is_empty(), "{} has a known fault: {}", gpu.name, faulty.join("; "));
    Ok(())
}

impl Row {
    fn new(what: &'static str, results: &[Seen], is_wrong: impl Fn(usize, &Seen) -> bool) -> Self {
        let wrong = results.iter().enumerate().filter(|&(i, seen)| is_wrong(i, seen)).count();
        Self { what, rays: results.len(), wrong, places: Vec::new() }
    }

    fn line(&self) -> String {
        let Self { what, rays, wrong, places } = self;
        let places =
            if places.is_empty() { String::new() } else { format!(" {}", places.join(", ")) };
        match wrong {
            0 => format!("{what}: all {rays} rays are right"),
            _ => format!("{what}: {wrong} of {rays} rays are wrong{places}"),
        }
    }
}

/// Small boxes at the points of a cube; each `state` moves them all, each in its own way, across the whole cube.
fn boxes(state: u32) -> Vec<[Vec3; 2]> {
    let corner = |i: usize| {
        // An odd factor sends the points of a state to each other: no two boxes are at the same place.
        let place = i * [1, 1_541][state as usize] % SIDE.pow(3);
        let at = [place % SIDE, place / SIDE % SIDE, place / SIDE.pow(2)];
        Vec3::from_array(at.map(|k| k as f32))
    };
    (0..SIDE.pow(3)).map(corner).map(|low| [low, low + 0.25]).collect()
}

/// A ray to the middle of each box, from one unit away.
fn aims(boxes: &[[Vec3; 2]]) -> Vec<Aim> {
    let direction = Vec3::new(0.36, 0.48, 0.8);
    let aim = |(i, [low, high]): (usize, &[Vec3; 2])| {
        let toward = if i % 2 == 0 { direction } else { -direction };
        Aim { origin: 0.5 * (low + high) - toward, wanted: i as u32, direction: toward }
    };
    boxes.iter().enumerate().map(aim).collect()
}

/// The rays that no longer meet their box. With `after` the boxes are moved by an update first.
fn lost(
    what: &'static str,
    gpu: &Gpu,
    before: &[[Vec3; 2]],
    after: Option<&[[Vec3; 2]]>,
) -> Result<Row> {
    let options = BuildOptions { updatable: true, ..BuildOptions::default() };
    let count = before.len() as u32;
    let input = |boxes: &[[Vec3; 2]]| boxes_on_gpu(gpu, "boxes", boxes);
    let geometry = |boxes: &Buffer| Geometry::Aabbs { boxes: boxes.address, count, opaque: true };
    let built = input(before)?;
    let blas = AccelerationStructure::bottom(gpu, "boxes", &[geometry(&built)], options)?;
    if let Some(after) = after {
        let (moved, scratch) = (input(after)?, blas.scratch()?);
        gpu.submit(|cmd| blas.update(cmd, &[geometry(&moved)], &scratch))?;
    }
    let tlas = build_top(gpu, &[instance(&IDENTITY, 0, blas.address)])?;
    let results = trace(gpu, &tlas, &aims(after.unwrap_or(before)), false)?;
    Ok(Row::new(what, &results, |i, seen| seen.primitive != i as u32))
}

/// The rays for which a shader received other hit attributes than the intersection shader wrote.
fn wrong_attributes(gpu: &Gpu, boxes: &[[Vec3; 2]]) -> Result<Row> {
    let input = boxes_on_gpu(gpu, "boxes", boxes)?;
    let count = boxes.len() as u32;
    let geometry = Geometry::Aabbs { boxes: input.address, count, opaque: false };
    let blas = AccelerationStructure::bottom(gpu, "boxes", &[geometry], BuildOptions::default())?;
    let tlas = build_top(gpu, &[instance(&IDENTITY, 0, blas.address)])?;
    let nested = gpu.limits.ray_tracing_pipeline.max_ray_recursion_depth > 1;
    let results = trace(gpu, &tlas, &aims(boxes), nested)?;
    let what = if nested { "hit attributes" } else { "hit attributes, without nested rays" };
    let mut row = Row::new(what, &results, |_, seen| seen.wrong != 0);
    let is_set = |&&(bit, _): &&(u32, &str)| results.iter().any(|seen| seen.wrong & bit != 0);
    row.places = WRONG.iter().filter(is_set).map(|(_, place)| (*place).to_owned()).collect();
    Ok(row)
}

/// The rays that hit something in a top level without active instances.
fn empty_top_level(gpu: &Gpu, instances: &[vk::AccelerationStructureInstanceKHR]) -> Result<Row> {
    let what = if instances.is_empty() {
        "a top level without instances"
    } else {
        "a top level whose only instance refers to nothing"
    };
    let tlas = build_top(gpu, instances)?;
    let results = trace(gpu, &tlas, &aims(&boxes(0)), false)?;
    Ok(Row::new(what, &results, |_, seen| seen.primitive != NOTHING))
}

fn trace(gpu: &Gpu, tlas: &AccelerationStructure, aims: &[Aim], nested: bool) -> Result<Vec<Seen>> {
    let group = HitGroup::procedural("faults.rint").any_hit("faults.rahit");
    let pipeline = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("faults.rgen")
        .miss("faults.rmiss")
        .hit(group.closest_hit(if nested { "faults_nested.rchit" } else { "faults.rchit" }))
        .recursion(if nested { 2 } else { 1 })
        .binding(Binding::AccelerationStructure)
        .push_constants::<Push>()
        .build(gpu)?;
    let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
    let inputs = Buffer::with_data(gpu, "aims", aims, input_usage())?;
    let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_SRC;
    let results = Buffer::new(gpu, "results", (aims.len() * size_of::<Seen>()) as u64, usage)?;
    let count = aims.len() as u32;
    let push = Push { aims: inputs.address.into(), results: results.address.into(), count };
    let extent = vk::Extent2D { width: WIDTH, height: count.div_ceil(WIDTH) };
    gpu.submit(|cmd| {
        pipeline.bind(cmd, &[Descriptor::AccelerationStructure(tlas)], &push)?;
        sbt.trace(cmd, extent.into());
        barrier::trace_to_trace(gpu, cmd);
        Ok(())
    })?;
    results.read()
}
