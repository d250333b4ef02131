//! How long builds take, beside the driver's own.

use std::time::Instant;

use common::gpu::{AccelerationStructure, BuildOptions, Geometry};
use common::scene::{Vertex, input_usage};
use patience::Work;

use super::*;

/// Milliseconds that something took on the clock, and that processors have worked for it, all of them together: the
/// least of some tries. Beside other programs the second is the one to compare; a GPU's work is not in it.
struct Times {
    clock: f64,
    work: f64,
}

impl Times {
    fn of(mut something: impl FnMut()) -> Self {
        let worked = || Work::of_process(std::process::id()).done().unwrap_or_default();
        let mut least = Self { clock: f64::INFINITY, work: f64::INFINITY };
        for _ in 0..5 {
            let (start, before) = (Instant::now(), worked());
            something();
            least.clock = least.clock.min(start.elapsed().as_secs_f64() * 1e3);
            least.work = least.work.min((worked() - before).as_secs_f64() * 1e3);
        }
        least
    }
}

/// What the driver builds of the same triangles.
fn geometry(input: &Uploaded, vertex_count: u32) -> [Geometry; 1] {
    [Geometry::Triangles {
        vertices: input.vertices.address,
        vertex_stride: size_of::<Vertex>() as u64,
        vertex_count,
        indices: input.triangles.address,
        count: input.count,
        opaque: true,
        no_duplicate_any_hit: false,
    }]
}

#[test]
#[ignore = "by hand: takes times"]
fn builds_and_refits_beside_the_drivers_own() {
    let gpu = gpu(false, Arithmetic::Driver);
    let builder = DeviceBuilder::new(&gpu).unwrap();
    println!("{}: milliseconds, and those of all processors together", gpu.name);
    println!("{:>10} {:>18} {:>18} {:>18}", "triangles", "build", "refit", "driver's build");
    for count in [1_000, 10_000, 100_000, 1_000_000] {
        for shape in [shapes::soup(count, 1), shapes::cloth(count.isqrt(), count.isqrt() / 2)] {
            let input = Uploaded::with_usage(&gpu, &shape, input_usage());
            let tree = DeviceTree::new(&gpu, input.count).unwrap();
            let scratch = Scratch::new(&gpu, input.count).unwrap();
            let build = || {
                gpu.submit(|cmd| builder.record(cmd, input.input(), &tree, &scratch)).unwrap();
            };
            let refit = || {
                gpu.submit(|cmd| builder.refit(cmd, input.input(), &tree, &scratch)).unwrap();
            };
            let geometry = geometry(&input, shape.vertices.len() as u32);
            // With its memory: the framework has no other way to build.
            let driver = || {
                let options = BuildOptions::default();
                AccelerationStructure::bottom(&gpu, "beside", &geometry, options).unwrap();
            };
            print!("{:>10}", input.count);
            for Times { clock, work } in [Times::of(build), Times::of(refit), Times::of(driver)] {
                print!(" {clock:>9.2} {work:>8.2}");
            }
            println!("  {}", shape.name);
        }
    }
}
