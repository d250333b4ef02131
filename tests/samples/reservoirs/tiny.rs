//! The same two pixels on the device: the shaders do what the model does.

use std::f64::consts::PI;
use std::fmt::Write;
use std::fs;

use dashu::rational::RBig;
use glam::DVec3;
use reference::rational::{rational, to_f64};
use tempfile::TempDir;

use super::chapter;
use super::model::{Rules, Weights, World, both, whole};

const LAMPS: [(DVec3, f64); 3] = [
    (DVec3::new(0.0, 0.3, 1.0), 20_000.0),
    (DVec3::new(0.0, -0.3, 1.0), 60_000.0),
    (DVec3::new(-0.5, 0.0, 0.8), 10_000.0),
];
const PIXELS: [DVec3; 2] = [DVec3::new(-0.4, 0.0, 0.0), DVec3::new(0.4, 0.0, 0.0)];
/// Each pixel has a lamp that something hides.
const HIDDEN: [usize; 2] = [0, 1];
/// Half the side of a lamp's triangle.
const HALF: f64 = 0.004;

/// A white floor, three small lamps above it, and two black squares, each halfway between a pixel and a lamp.
pub fn scene() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut materials =
        "newmtl white\nKd 1 1 1\nillum 1\nnewmtl black\nKd 0 0 0\nillum 1\n".to_owned();
    let mut text = "mtllib tiny.mtl\n".to_owned();
    let mut count = 0;
    let mut polygon = |material: &str, corners: &[DVec3]| {
        writeln!(text, "o {material}\nusemtl {material}").unwrap();
        corners.iter().for_each(|corner| {
            writeln!(text, "v {} {} {}", corner.x, corner.y, corner.z).unwrap();
        });
        let numbers: Vec<String> = (1..=corners.len()).map(|i| (count + i).to_string()).collect();
        writeln!(text, "f {}", numbers.join(" ")).unwrap();
        count += corners.len();
    };
    let square = |middle: DVec3, half: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| middle + half * DVec3::new(x, y, 0.0))
    };
    polygon("white", &square(DVec3::ZERO, 1.0));
    for (pixel, lamp) in PIXELS.iter().zip(HIDDEN) {
        polygon("black", &square(0.5 * (pixel + LAMPS[lamp].0), 0.05));
    }
    for (i, (middle, radiance)) in LAMPS.iter().enumerate() {
        writeln!(
            materials,
            "newmtl lamp{i}\nKd 0 0 0\nKe {radiance} {radiance} {radiance}\nillum 1"
        )
        .unwrap();
        let corners = [(-1.0, -1.0), (1.0, -1.0), (0.0, 2.0)];
        polygon(&format!("lamp{i}"), &corners.map(|(x, y)| middle + HALF * DVec3::new(x, y, 0.0)));
    }
    fs::write(folder.path().join("tiny.mtl"), materials).expect("the folder is writable");
    fs::write(folder.path().join("tiny.obj"), text).expect("the folder is writable");
    folder
}

/// The same in numbers: a lamp is as small as a point, up to some 10^-4.
fn world() -> World {
    // Half the base times the height.
    let area = 3.0 * HALF * HALF;
    let powers: f64 = LAMPS.iter().map(|lamp| lamp.1).sum();
    let light = |pixel: &DVec3, (lamp, radiance): &(DVec3, f64)| {
        let to = lamp - pixel;
        let cosine = to.z / to.length();
        rational(radiance * cosine * cosine * area / to.length_squared() / PI)
    };
    World {
        chosen: LAMPS.iter().map(|lamp| rational(lamp.1) / rational(powers)).collect(),
        light: PIXELS
            .iter()
            .map(|pixel| LAMPS.iter().map(|lamp| light(pixel, lamp)).collect())
            .collect(),
        seen: HIDDEN.iter().map(|&hidden| (0..3).map(|lamp| lamp != hidden).collect()).collect(),
    }
}

const NEIGHBOURS: u32 = 4;

/// The mean and the deviation of each pixel's light in one frame, by the model. A neighbour is one of three places
/// across: two of these are the pixel itself, at the picture's border, and do not count.
fn expected(world: &World, rules: Rules) -> [(f64, f64); 2] {
    let fresh = both(&world.candidates(rules, 0), &world.candidates(rules, 1));
    [0, 1].map(|pixel| {
        let (mut mean, mut square) = (RBig::ZERO, RBig::ZERO);
        for found in 0..=NEIGHBOURS {
            let ways = (0..found).fold(1, |ways, i| ways * (NEIGHBOURS - i) / (i + 1));
            let likely = whole(ways * 2u32.pow(NEIGHBOURS - found)) / whole(3u32.pow(NEIGHBOURS));
            for ((a, b), probability) in &fresh {
                let (own, other) = if pixel == 0 { (a, b) } else { (b, a) };
                let mut sources = vec![(pixel, own.clone())];
                sources.extend((0..found).map(|_| (1 - pixel, other.clone())));
                let moments = world.moments(pixel, &world.merged(rules, &sources));
                mean += &likely * probability * moments.0;
                square += &likely * probability * moments.1;
            }
        }
        let (mean, square) = (to_f64(&mean), to_f64(&square));
        (mean, (square - mean * mean).max(0.0).sqrt())
    })
}

/// The mean of so many frames on the device.
fn shown(folder: &TempDir, weights: &str, visibility: bool, frames: u32) -> [f64; 2] {
    let sets = [
        "camera eye=0,0,4",
        "camera target=0,0,0",
        "field of view=11.42118626",
        "show=mean",
        "sky=black",
        "reuse=space",
        "jitter=off",
        "candidates=2",
        "radius=1",
    ];
    let picture = chapter()
        .size("2x1")
        .scene(folder.path().join("tiny.obj"))
        .sets(&sets)
        .set("neighbours", NEIGHBOURS)
        .set("weights", weights)
        .set("visibility", if visibility { "on" } else { "off" })
        .frames(frames)
        .picture();
    [0, 1].map(|pixel| f64::from(picture.pixels[pixel][0]))
}

fn compare(cases: &[(Weights, &str, bool)], frames: u32) {
    let (folder, world) = (scene(), world());
    let truth = [0, 1].map(|pixel| to_f64(&world.truth(pixel)));
    for &(weights, name, visibility) in cases {
        let rules = Rules { weights, visibility, candidates: 2, most: 1 };
        let model = expected(&world, rules);
        let shown = shown(&folder, name, visibility, frames);
        for pixel in [0, 1] {
            let (mean, deviation) = model[pixel];
            // The lamps are no points, and a running mean of floats is rounded at each step.
            let bound = 4.0 * deviation / f64::from(frames).sqrt() + 1e-3 * mean;
            println!(
                "{name}, visibility {visibility}, pixel {pixel}: {:.5}, model {mean:.5} ± {bound:.5}, truth {:.5}",
                shown[pixel], truth[pixel]
            );
            assert!((shown[pixel] - mean).abs() < bound, "{name}: {} {mean}", shown[pixel]);
            if weights == Weights::OneOverM && visibility {
                let bias = (mean - truth[pixel]).abs();
                assert!(bias > 2.0 * bound, "the test tells bias from noise: {bias} {bound}");
            } else {
                assert!((mean / truth[pixel] - 1.0).abs() < 1e-12, "{mean} {}", truth[pixel]);
            }
        }
    }
}

#[test]
fn the_device_has_the_means_of_the_model() {
    compare(&[(Weights::OneOverM, "1/M", true), (Weights::Balance, "balance", true)], 2048);
}

#[test]
#[ignore = "nightly: six kinds of weights; quick: reservoirs::tiny::the_device_has_the_means_of_the_model"]
fn it_has_them_with_all_weights() {
    let cases = Weights::ALL.into_iter();
    let cases = cases.flat_map(|(weights, name)| [true, false].map(|on| (weights, name, on)));
    compare(&cases.collect::<Vec<_>>(), 16_384);
}
