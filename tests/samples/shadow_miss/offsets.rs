//! Starts of shadow rays in patched copies of the shaders: the benefit and the cost of the bound on the offset.

use std::ffi::OsStr;
use std::fs;
use std::path::Path;

use common::app::Picture;
use serde_json::{Map, Value, json};

use super::{FIRST_HIT, NAME};
use run::{command, copy_of_shaders, expected, flat_shaders, replace_line};

/// Runs by shaders with a line replaced, where rays leave triangles as they are.
fn patched(file: &str, from: &str, to: &str, more: &[&str]) -> (Picture, f64) {
    let shaders = flat_shaders();
    replace_line(shaders.path(), file, from, to);
    run_by(shaders.path(), more)
}

/// Runs by these shaders, and returns a picture of 480×300 and the milliseconds of a frame.
fn run_by(shaders: &Path, more: &[&str]) -> (Picture, f64) {
    let [out, report] = ["out.exr", "report.json"].map(|name| shaders.join(name));
    let run = command(NAME)
        .env("SHADERS", shaders)
        .args(["--headless", "--size", "480x300"])
        .args(more)
        .args([OsStr::new("--out"), out.as_os_str(), "--report".as_ref(), report.as_ref()])
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let report: Value = serde_json::from_slice(&fs::read(&report).unwrap()).unwrap();
    let milliseconds = report["gpu_milliseconds"]["min"].as_f64().unwrap();
    (Picture::open_exr(&out).unwrap(), milliseconds)
}

/// The bound of `ray_offset.glsl`, and the line of `shade.rchit` after which a hit has its place.
const BOUND: &str = "at.offset = ROUNDING * (dot(abs(at.face), error_bound) + test);";
const PLACED: &str = "    hit.lift = at.lift;\n";

/// Pixels that become dark by mistake where the origin is nearer to the surface than the bound says.
#[test]
fn specks_come_where_the_bound_is_not_kept() {
    let shadow = |file, from, to: &str| patched(file, from, to, &["--set", "show=shadow"]).0;
    let right = shadow("common/ray_offset.glsl", BOUND, BOUND);
    let lit = right.pixels.iter().filter(|pixel| is_lit(pixel)).count();
    let mut scaled = Map::new();
    for factor in ["1.0", "0.3", "0.1", "0.03", "0.01", "0.0"] {
        let picture = shadow(
            "common/ray_offset.glsl",
            BOUND,
            &BOUND.replace("ROUNDING", &format!("{factor} * ROUNDING")),
        );
        scaled.insert(factor.to_owned(), dark(&right, &picture).into());
    }
    println!("{lit} lit; dark by the offset's factor: {scaled:?}");
    scaled.insert("lit".to_owned(), lit.into());
    expected::hold("05_shadow_miss/scaled", scaled.into());
}

fn is_lit(pixel: &[f32; 4]) -> bool {
    pixel[0] == 1.0 && pixel[2] == 1.0
}

/// Number of lit pixels that are dark in another picture.
fn dark(right: &Picture, picture: &Picture) -> usize {
    let pairs = right.pixels.iter().zip(&picture.pixels);
    pairs.filter(|(before, after)| is_lit(before) && after[0] == 0.0).count()
}

/// Pixels that become dark where the ray starts at o + t d.
#[test]
fn the_hit_s_own_point_is_no_start() {
    let shaders = copy_of_shaders();
    let shadow = || run_by(shaders.path(), &["--set", "show=shadow"]).0;
    let right = shadow();
    let from_t = format!(
        "{PLACED}    hit.position = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;\n    \
         hit.offset = 0.0;\n"
    );
    replace_line(shaders.path(), "05_shadow_miss/shade.rchit", PLACED, &from_t);
    let lit = right.pixels.iter().filter(|pixel| is_lit(pixel)).count();
    let acne = dark(&right, &shadow());
    println!("of {lit} lit, {acne} dark where the ray starts at o + t d");
    expected::hold("05_shadow_miss/acne", json!({ "lit": lit, "dark": acne }));
    assert!(acne > lit / 10, "{acne} of {lit}");
}

/// A frame's time with the bound, over that with an offset that is chosen by eye.
#[test]
#[ignore = "by hand: takes times"]
fn the_bound_in_time() {
    let by_eye = format!(
        "{PLACED}    hit.position = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;\n    \
         hit.offset = 0.001;\n"
    );
    let time = |to: &str| patched("05_shadow_miss/shade.rchit", PLACED, to, &["--frames", "5"]).1;
    expected::give_timed("05_shadow_miss/bound", ratio(|| time(PLACED) / time(&by_eye)));
}

/// A frame's time where shadow rays go on to the nearest hit, over that where the first hit ends them.
#[test]
#[ignore = "by hand: takes times"]
fn the_first_hit_in_time() {
    let [with, without] = FIRST_HIT;
    let low_sun = ["--frames", "5", "--set", "sun elevation=5"];
    let time = |to: &str| patched("common/shadow.glsl", with, to, &low_sun).1;
    expected::give_timed("05_shadow_miss/flags", ratio(|| time(without) / time(with)));
}

/// The middle of 20 ratios, and where the middle half of them lies.
fn ratio(of: impl Fn() -> f64) -> Value {
    let mut ratios: Vec<f64> = (0..20).map(|_| of()).collect();
    ratios.sort_by(f64::total_cmp);
    let [low, ratio, high] = [5, 10, 15].map(|at| ratios[at]);
    println!("{ratio:.2}, middle half {low:.2} to {high:.2}");
    json!({ "ratio": ratio, "low": low, "high": high })
}
