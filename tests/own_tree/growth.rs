//! The growth of steps and build times with the number of triangles, and the effect of a refit on a tree.

use std::hint::black_box;
use std::time::Instant;

use common::glam::DQuat;
use common::gpu::{AccelerationStructure, BuildOptions, Geometry};
use common::scene::{Scene, Vertex};
use own_tree::{
    Bounds, Builder, Corners, DeviceBuilder, DeviceTree, Scratch, binned, cost, refit, reinserted,
};
use run::expected;
use serde_json::{Map, Value};

use crate::device::{Uploaded, gpu_to_be_timed};
use crate::rate::{landscape, primary};
use crate::rig::{BEST, By, Rig};
use crate::scenes;

/// The rows and columns of landscapes of about 10^3, 10^4, 10^5 and 10^6 triangles.
const SIDES: [u32; 4] = [23, 72, 225, 708];

/// The shortest of some times, in milliseconds.
fn least(times: u32, mut make: impl FnMut()) -> f64 {
    let mut run = || {
        let start = Instant::now();
        make();
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..times).map(|_| run()).fold(f64::INFINITY, f64::min)
}

fn bounds(scene: &Scene) -> Vec<Bounds> {
    scenes::triangles(scene).iter().map(|&[a, b, c]| Corners { a, b, c }.bounds()).collect()
}

/// The average number of nodes and triangles tested by a ray through a pixel.
fn steps(scene: &Scene, builder: Builder) -> f64 {
    let rig = Rig::beside_the_device(scene, builder);
    let rays = primary(scene, [480, 300]);
    let (answers, _) = rig.answers(&rig.way(By::Walk, BEST), &rays);
    answers.iter().map(|answer| f64::from(answer.count)).sum::<f64>() / rays.len() as f64
}

/// Milliseconds of builds on the host: binned, and the additional time for reinsertion.
fn on_host(scene: &Scene) -> [(&'static str, f64); 3] {
    let bounds = bounds(scene);
    let tree = binned(&bounds);
    let mut moved = tree.clone();
    [
        ("binned", least(5, || drop(black_box(binned(&bounds))))),
        ("reinserted", least(1, || drop(black_box(reinserted(tree.clone(), &bounds, 3))))),
        ("host_refit", least(5, || refit(&mut moved, &bounds))),
    ]
}

/// The same on the device, and for the driver's own build.
fn on_device(scene: &Scene) -> [(&'static str, f64); 3] {
    let gpu = gpu_to_be_timed();
    let builder = DeviceBuilder::new(&gpu).unwrap();
    let mesh = &scene.model.meshes[0];
    let input = Uploaded::of_mesh(&gpu, mesh);
    let tree = DeviceTree::new(&gpu, input.count).unwrap();
    let scratch = Scratch::new(&gpu, input.count).unwrap();
    let build = || gpu.submit(|cmd| builder.record(cmd, input.input(), &tree, &scratch)).unwrap();
    let refit = || gpu.submit(|cmd| builder.refit(cmd, input.input(), &tree, &scratch)).unwrap();
    let geometry = [Geometry::Triangles {
        vertices: input.vertices.address,
        vertex_stride: size_of::<Vertex>() as u64,
        vertex_count: mesh.vertices.len() as u32,
        indices: input.triangles.address,
        count: input.count,
        opaque: true,
        no_duplicate_any_hit: false,
    }];
    // With the allocation: the framework has no separate build.
    let driver = || {
        let options = BuildOptions::default();
        AccelerationStructure::bottom(&gpu, "beside", &geometry, options).unwrap();
    };
    [("device", least(5, build)), ("refit", least(5, refit)), ("driver", least(5, driver))]
}

#[test]
#[ignore = "by hand: takes times"]
fn from_a_thousand_triangles_to_a_million() {
    let mut figures = Map::new();
    for (side, power) in SIDES.into_iter().zip(3..) {
        let scene = landscape(side);
        let mut give = |name: &str, value: Value| {
            println!("10^{power} {name}: {value:.2}");
            figures.insert(format!("e{power}.{name}"), value);
        };
        give("triangles", scene.model.meshes[0].triangles.len().into());
        for builder in [Builder::Binned, Builder::Reinserted, Builder::Device] {
            give(&format!("steps.{builder:?}").to_lowercase(), steps(&scene, builder).into());
        }
        for (name, milliseconds) in on_host(&scene).into_iter().chain(on_device(&scene)) {
            give(name, milliseconds.into());
        }
    }
    expected::give_timed("30_own_tree/growth", figures.into());
}

/// Twists a landscape, by this many turns per unit from its middle.
#[test]
fn a_tree_that_is_refitted_gets_worse() {
    let scene = landscape(72);
    let still = scenes::triangles(&scene);
    let built = binned(&bounds(&scene));
    let mut figures = Map::new();
    let mut ratios = Vec::new();
    for (name, turns) in [("none", 0.0), ("little", 0.05), ("half", 0.5), ("full", 1.0)] {
        let wound = still.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|corner| {
                let corner = corner.as_dvec3();
                let angle = turns * std::f64::consts::TAU * corner.length();
                (DQuat::from_rotation_y(angle) * corner).as_vec3()
            });
            Corners { a, b, c }.bounds()
        });
        let wound: Vec<_> = wound.collect();
        let mut tree = built.clone();
        refit(&mut tree, &wound);
        own_tree::check(&tree, &wound).unwrap();
        let ratio = cost(&tree) / cost(&binned(&wound));
        println!("{turns} turns: a refitted tree costs {ratio:.2} times as much as one built anew");
        figures.insert(name.to_owned(), ratio.into());
        ratios.push(ratio);
    }
    expected::hold_exact("30_own_tree/refitted", figures.into());
    assert!((ratios[0] - 1.0).abs() < 1e-9);
    assert!(ratios.windows(2).all(|pair| pair[0] < pair[1]), "{ratios:?}");
    assert!(ratios[3] > 1.5, "{ratios:?}");
}
