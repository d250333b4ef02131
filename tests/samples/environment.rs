//! 46_environment: four samplers find the same light, densities are exact, and a single texel lights as in f64.

mod light;
mod plots;
#[allow(dead_code, reason = "the chapter uploads it")]
#[path = "../../samples/46_environment/sky.rs"]
mod sky;
mod table;

use std::path::Path;

use super::emitters::caught::alias;
use super::rough_metal::{self, Estimate, brightness, difference, twin};
use common::app::Picture;
use common::model::panorama::Panorama;
use common::scene::assets;
use run::{
    Chapter, bits, command, copy_of_shaders, refused, replace_line, same_colors, set_arguments,
};
use tempfile::TempDir;

const NAME: &str = "46_environment";

const SAMPLERS: [&str; 4] = ["bounces", "uniform", "map", "both"];

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// One of the book's own skies.
fn own_sky(name: &str) -> Panorama {
    Panorama::open(&assets().join(name)).expect("the sky can be read").0
}

/// Writes a sky.
fn write_sky(path: &Path, sky: &Panorama) {
    let pixels = sky.texels.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect();
    let Panorama { width, height, .. } = *sky;
    Picture { width, height, pixels }.save(path).expect("a sky can be written");
}

/// The results of this chapter's functions, one per pixel: `body` reads the pixel from `uvec2 at` and sets `vec4
/// answer`; `declarations` come before it. The facets' light is that of 45 without compensation.
fn evaluate(declarations: &str, body: &str, size: &str, arguments: &[&str]) -> Picture {
    evaluate_in(&copy_of_shaders(), declarations, body, size, arguments)
}

/// As [`evaluate`], with these shaders.
fn evaluate_in(
    folder: &TempDir,
    declarations: &str,
    body: &str,
    size: &str,
    arguments: &[&str],
) -> Picture {
    replace_line(
        folder.path(),
        "46_environment/push.glsl",
        "const bool COMPENSATION = true;",
        "const bool COMPENSATION = false;",
    );
    rough_metal::evaluate_in((NAME, folder), declarations, body, size, arguments)
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(4).repeats();
}

/// The sky of a furnace has no texel that a bounce would miss.
#[test]
fn a_furnace_is_that_of_45() {
    let picture = |name: &str, sets: &[&str]| {
        let common = ["scene=furnace", "depth=256"];
        Chapter::new(name).size("60x20").frames(8).sets(&common).sets(sets).picture()
    };
    let other = picture("45_rough_metal", &[]);
    same_colors("the furnaces of 45 and 46", NAME, &other, &picture(NAME, &["sampling=bounces"]));
    let rough = picture("45_rough_metal", &["roughness=0.6"]);
    for sampler in &SAMPLERS[1..] {
        let own = picture(NAME, &[&format!("sampling={sampler}"), "seed=1", "roughness=0.6"]);
        let Estimate { mean, confidence } = difference(&own, &rough);
        println!("{sampler} - 45: {mean:.5} ± {confidence:.5}");
        assert!(mean.abs() < confidence, "{sampler}: {mean} ± {confidence}");
    }
}

#[test]
fn a_whole_turn_changes_nothing_and_a_quarter_moves_the_columns() {
    let run = |sets: &[&str]| chapter("60x40").frames(2).sets(&["sky=evening"]).sets(sets);
    let still = run(&[]).picture();
    for turn in ["rotation=360", "rotation=-360"] {
        assert_eq!(bits(&run(&[turn]).picture()), bits(&still), "{turn}");
    }
    let turned = run(&["rotation=90", "sampling=bounces"]).picture();
    assert_ne!(bits(&turned), bits(&run(&["sampling=bounces"]).picture()));
    let sky = own_sky("evening.exr");
    let (width, quarter) = (sky.width as usize, sky.width as usize / 4);
    let moved = |i: usize| sky.texels[i - i % width + (i % width + quarter) % width];
    let moved = Panorama { texels: (0..sky.texels.len()).map(moved).collect(), ..sky.clone() };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("moved.exr");
    write_sky(&file, &moved);
    let file = file.to_str().expect("plain letters");
    let sets = ["sampling=bounces"];
    let other = chapter("60x40").frames(2).with(&["--sky", file]).sets(&sets).picture();
    // A direction at the edge of a texel may round to the next one.
    let pairs = turned.pixels.iter().zip(&other.pixels);
    let unlike = pairs.filter(|(one, other)| {
        let off = |i: usize| (one[i] - other[i]).abs() > 1e-4 * one[i].abs().max(0.1);
        (0..3).any(off)
    });
    let unlike = unlike.count();
    println!("{unlike} of {} pixels differ", turned.pixels.len());
    assert!(unlike < turned.pixels.len() / 50, "{unlike}");
}

#[test]
fn a_wrong_sky_is_refused_in_a_line() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("plain letters").to_owned();
    std::fs::write(path("cut.exr"), b"\x76\x2f\x31\x01\x02\0\0\0").expect("a file can be written");
    std::fs::write(path("a.png"), b"\x89PNG\r\n\x1a\n").expect("a file can be written");
    for (file, words) in [
        (path("none.exr"), "there is no such file"),
        (path(""), "is not a file that can be read"),
        (path("cut.exr"), "it is damaged or cut off"),
        (path("a.png"), "is not an EXR file; save it as .exr"),
    ] {
        let (code, line) = refused(NAME, &["--headless", "--sky", &file]);
        assert!(code == 1 && line.contains(words), "{line}");
    }
    for (name, arguments, words) in [
        ("45_rough_metal", ["--sky", "a.exr"], "brings its own sky and takes no --sky"),
        (NAME, ["--set", "sky=file"], "sky=file shows the file of --sky FILE.exr"),
    ] {
        let (code, line) = refused(name, &[&["--headless"], &arguments[..]].concat());
        assert!(code == 2 && line.contains(words), "{line}");
    }
}

#[test]
fn what_is_no_light_is_warned_of_and_black() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("wrong.exr");
    let mut sky = own_sky("evening.exr");
    (sky.texels[7][0], sky.texels[9][2]) = (f32::NAN, -1.0);
    write_sky(&file, &sky);
    let file = file.to_str().expect("plain letters");
    let out = folder.path().join("out.exr");
    let output = command(NAME)
        .args(["--headless", "--size", "32x20", "--sky", file, "--out"])
        .arg(&out)
        .output()
        .expect("the sample starts");
    let line = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.success() && line.contains("no number, so it is black (2 in all)"),
        "{line}"
    );
    let picture = Picture::open_exr(&out).expect("a picture");
    assert!(picture.pixels.iter().flatten().all(|value| value.is_finite()));
}

#[test]
fn the_skies_are_as_their_program_makes_them() {
    let output = command("skies").arg("--check").output().expect("it starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// `sets` as the arguments of a run.
fn set(sets: &[&str]) -> Vec<String> {
    set_arguments(sets).into_iter().map(str::to_owned).collect()
}
