//! Calls the chapter's functions for given rays and shapes, in the driver's arithmetic or in the worst.

use std::sync::Arc;

use common::gpu::{
    Address, Buffer, Gpu, GpuOptions, RayTracingPipeline, Requirements, ShaderBindingTable, barrier,
};
use common::scene::input_usage;
use glam::{DVec3, Vec3};
use instruments::arithmetic::Arithmetic;
use reference::Ray;
use reference::torus::Torus;

/// A ray and a torus; all numbers are f32.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub ray: Ray,
    pub torus: Torus,
}

common::shader_struct! {
    struct Query {
        origin: Vec3,
        direction: Vec3,
        center: Vec3,
        axis: Vec3,
        major: f32,
        minor: f32,
        tmin: f32,
    }
}

common::shader_struct! {
    /// A crossing of a line with the surface.
    struct TorusCrossing {
        t: f32,
        ring: Vec3,
        outward: Vec3,
    }
}

common::shader_struct! {
    struct Answer {
        hit: u32,
        first: TorusCrossing,
    }
}

common::shader_struct! {
    struct Push {
        queries: Address<Query>,
        answers: Address<Answer>,
    }
}

/// The folder of the test's shader in a copy of the book's shaders.
const FOLDER: &str = "roots_of_a_test";

/// Runs a test of this program in a process of its own, so that it can have its own shaders.
pub fn run_alone(test: &str) {
    let shaders = run::copy_of_shaders();
    let folder = shaders.path().join(FOLDER);
    std::fs::create_dir(&folder).expect("a copy can be written");
    std::fs::write(folder.join("direct.rgen"), include_str!("direct.rgen"))
        .expect("a copy can be written");
    let this = std::env::current_exe().expect("a running program has a file");
    let mut command = std::process::Command::new(this);
    command.args([test, "--exact", "--ignored", "--nocapture"]).env("SHADERS", shaders.path());
    let output = command.output().expect("the test starts");
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{said}");
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    assert!(said.contains("1 passed"), "no test is named {test}");
}

/// A method's result for a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    pub t: f32,
    pub normal: DVec3,
}

/// A device with the given arithmetic.
pub fn device(arithmetic: Arithmetic) -> Gpu {
    let requirements = Requirements::ray_tracing();
    let driver_shim = Arc::new(arithmetic);
    Gpu::new(&GpuOptions { requirements, driver_shim, ..GpuOptions::default() }).expect("a device")
}

/// The first hit of each ray by a method, given by its number in the shader.
pub fn call(gpu: &Gpu, method: u32, conditioned: bool, cases: &[Case]) -> Vec<Option<Found>> {
    let pipeline = RayTracingPipeline::builder(FOLDER)
        .raygen("direct.rgen")
        .constant(0, method)
        .constant(1, conditioned)
        .rounding_to_nearest_even(gpu)
        .push_constants::<Push>()
        .build(gpu)
        .unwrap();
    let sbt = ShaderBindingTable::new(gpu, &pipeline).unwrap();
    let query = |Case { ray, torus }: &Case| Query {
        origin: ray.origin.as_vec3(),
        direction: ray.direction.as_vec3(),
        center: torus.center.as_vec3(),
        axis: torus.axis.as_vec3(),
        major: torus.major as f32,
        minor: torus.minor as f32,
        tmin: ray.tmin as f32,
    };
    let queries: Vec<Query> = cases.iter().map(query).collect();
    let input = Buffer::with_data(gpu, "queries", &queries, input_usage()).unwrap();
    let usage = input_usage() | ash::vk::BufferUsageFlags::TRANSFER_SRC;
    let size = (cases.len() * size_of::<Answer>()) as u64;
    let output = Buffer::new(gpu, "answers", size, usage).unwrap();
    let push = Push { queries: input.address.into(), answers: output.address.into() };
    let extent = ash::vk::Extent2D { width: cases.len() as u32, height: 1 };
    gpu.submit(|cmd| {
        pipeline.bind(cmd, &[], &push)?;
        sbt.trace(cmd, extent.into());
        barrier::trace_to_trace(gpu, cmd);
        Ok(())
    })
    .unwrap();
    let mut answers: Vec<Answer> = output.read().unwrap();
    answers.truncate(cases.len());
    let first = |(answer, case): (Answer, &Case)| {
        let TorusCrossing { t, outward, .. } = answer.first;
        let is_hit = answer.hit != 0 && case.ray.contains(t.into());
        is_hit.then(|| Found { t, normal: outward.as_dvec3() })
    };
    answers.into_iter().zip(cases).map(first).collect()
}
