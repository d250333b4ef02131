//! The cost of a ray of 41_ray_offset: each part removed in turn, measured by the clock and by GPU compilers.

use instruments::compile_for::RADEON;
use run::{command, expected, shaders_with};
use serde_json::{Map, Value};
use tempfile::TempDir;

use super::NAME;

/// A part, its file and line, and the replacement without it. The picture then differs or is empty, which
/// does not matter.
const PARTS: [(&str, &str, &str, &str); 5] = [
    (
        "shadow ray",
        "41_ray_offset/camera.rgen",
        "visible = visibility(start, push.light.direction, 1e30);",
        "visible = 1.0;",
    ),
    (
        "height",
        "common/ray_offset.glsl",
        "at.offset = ROUNDING * (dot(abs(at.face), error_bound) + test);",
        "at.offset = 1e-4;",
    ),
    ("texture", "41_ray_offset/shade.rchit", "if (material.base_texture >= 0) {", "if (false) {"),
    (
        "original",
        "41_ray_offset/shade.rchit",
        "uint triangle = instance.original.at[gl_PrimitiveID];",
        "uint triangle = gl_PrimitiveID;",
    ),
    (
        "store",
        "41_ray_offset/camera.rgen",
        "imageStore(picture, ivec2(id), pixel);",
        "if (pixel.x == -7.0) imageStore(picture, ivec2(id), pixel);",
    ),
];

/// Generations of navi21, navi31 and gfx1201.
const GENERATIONS: &str = "RDNA2, RDNA3, RDNA4";

/// The report of a run, with a copy of the shaders if there is one.
fn report(shaders: Option<&TempDir>, arguments: &[&str]) -> Value {
    let mut command = command(NAME);
    if let Some(folder) = shaders {
        command.env("SHADERS", folder.path());
    }
    let output = command.args(arguments).args(["--report", "-"]).output().expect("it starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("a report")
}

#[test]
#[ignore = "by hand: takes times"]
fn what_a_ray_pays_for() {
    let copies = PARTS.map(|(_, file, line, without)| Some(shaders_with(file, line, without)));
    let ways: Vec<Option<&TempDir>> =
        std::iter::once(None).chain(copies.iter().map(Option::as_ref)).collect();
    let time = |shaders| {
        // With the model in its original position, triangles are the same with and without `original`.
        let arguments = ["--headless", "--size", "480x300", "--frames", "5", "--unordered"];
        report(shaders, &arguments)["gpu_milliseconds"]["min"].as_f64().expect("a time")
    };
    let mut ratios = vec![Vec::new(); ways.len()];
    for round in 0..15 {
        let mut times = vec![0.0; ways.len()];
        for turn in 0..ways.len() {
            let way = (turn + round) % ways.len();
            times[way] = time(ways[way]);
        }
        ratios.iter_mut().zip(&times).for_each(|(all, time)| all.push(time / times[0]));
    }
    let names = std::iter::once("all").chain(PARTS.map(|(name, ..)| name));
    let (mut taken, mut compiled, mut compiler) = (Map::new(), Map::new(), String::new());
    for ((name, way), mut ratios) in names.zip(&ways).zip(ratios) {
        let name = name.replace(' ', "-");
        ratios.sort_by(f64::total_cmp);
        let ratio = ratios[ratios.len() / 2];
        println!("{name}: {ratio:.3} of the time");
        taken.insert(format!("{name}.ratio"), ratio.into());
        let rows = report(*way, &["--compile-for", "all"])["compiled_for"].take();
        for row in rows.as_array().expect("rows") {
            let family = row["family"].as_str().expect("a family");
            if !RADEON.contains(&family) {
                continue;
            }
            for of in ["instructions", "registers", "latency"] {
                compiled.insert(format!("{name}.{family}.{of}"), row[of].clone());
            }
            compiler = row["compiler"].as_str().expect("a compiler").to_owned();
        }
    }
    expected::give_timed("prices/parts", taken.into());
    expected::hold_compiled("prices/compiled_parts", &compiler, GENERATIONS, compiled.into());
}
