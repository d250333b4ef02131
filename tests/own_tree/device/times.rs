//! How long builds take, beside the driver's own.

use std::time::Instant;

use common::gpu::{AccelerationStructure, BuildOptions, Geometry, Timer};
use common::scene::{Vertex, input_usage};

use super::*;

/// The least of some tries, in milliseconds of the device's clock.
fn least(gpu: &Gpu, mut record: impl FnMut(ash::vk::CommandBuffer)) -> f64 {
    let timer = Timer::new(gpu).unwrap();
    let tries = (0..5).map(|_| {
        gpu.submit(|cmd| {
            timer.start(cmd);
            record(cmd);
            timer.stop(cmd);
            Ok(())
        })
        .unwrap();
        timer.milliseconds().unwrap()
    });
    tries.fold(f64::INFINITY, f64::min)
}

/// The driver's build, with what the framework does around it: memory, and a wait.
fn of_driver(gpu: &Gpu, input: &Uploaded, vertex_count: u32) -> f64 {
    let geometry = [Geometry::Triangles {
        vertices: input.vertices.address,
        vertex_stride: size_of::<Vertex>() as u64,
        vertex_count,
        indices: input.triangles.address,
        count: input.count,
        opaque: true,
        no_duplicate_any_hit: false,
    }];
    let tries = (0..5).map(|_| {
        let start = Instant::now();
        AccelerationStructure::bottom(gpu, "beside", &geometry, BuildOptions::default()).unwrap();
        start.elapsed().as_secs_f64() * 1e3
    });
    tries.fold(f64::INFINITY, f64::min)
}

#[test]
#[ignore = "by hand: takes times"]
fn builds_and_refits_beside_the_drivers_own() {
    let gpu = gpu(false, Arithmetic::Driver);
    let builder = DeviceBuilder::new(&gpu).unwrap();
    println!(
        "{}\n{:>10} {:>10} {:>10} {:>10}  ms",
        gpu.name, "triangles", "build", "refit", "driver's"
    );
    for count in [1_000, 10_000, 100_000, 1_000_000] {
        for shape in [shapes::soup(count, 1), shapes::cloth(count.isqrt(), count.isqrt() / 2)] {
            let input = Uploaded::with_usage(&gpu, &shape, input_usage());
            let tree = DeviceTree::new(&gpu, input.count).unwrap();
            let scratch = Scratch::new(&gpu, input.count).unwrap();
            let build = least(&gpu, |cmd| {
                builder.record(cmd, input.input(), &tree, &scratch).unwrap();
            });
            let refit = least(&gpu, |cmd| {
                builder.refit(cmd, input.input(), &tree, &scratch).unwrap();
            });
            let driver = of_driver(&gpu, &input, shape.vertices.len() as u32);
            let Shape { name, .. } = shape;
            println!("{:>10} {build:>10.2} {refit:>10.2} {driver:>10.2}  {name}", input.count);
        }
    }
}
