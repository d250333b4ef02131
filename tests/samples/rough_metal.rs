//! 45_rough_metal: facets reflect what f64 says, three ways to choose them agree, and a white furnace is white.

#[path = "../../samples/45_rough_metal/albedo.rs"]
mod albedo;
mod functions;
mod furnace;
mod mitsuba;
mod models;
mod plots;
pub mod twin;

use common::app::Picture;
use tempfile::TempDir;

use run::{Chapter, command, copy_of_shaders, render_by, same_colors, set_arguments, shaders_with};

const NAME: &str = "45_rough_metal";

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// The results of this chapter's functions, one per pixel: `body` reads the pixel from `uvec2 at` and sets `vec4
/// answer`; `declarations` come before it.
fn evaluate(declarations: &str, body: &str, size: &str, arguments: &[&str]) -> Picture {
    evaluate_in((NAME, &copy_of_shaders()), declarations, body, size, arguments)
}

/// The same for a chapter, with a copy of the shaders that a test has changed.
pub fn evaluate_in(
    (name, folder): (&str, &TempDir),
    declarations: &str,
    body: &str,
    size: &str,
    arguments: &[&str],
) -> Picture {
    let file = folder.path().join(name).join("camera.rgen");
    let text = std::fs::read_to_string(&file).expect("it is there");
    let (head, _) = text.split_once("// One path per pixel").expect("a comment above main");
    let text = format!(
        "{head}\n{declarations}\nvoid main() {{ uvec2 at = pixel_id(); vec4 answer = vec4(0.0);\n{body}\n\
         imageStore(picture, ivec2(at), answer); }}"
    );
    std::fs::write(&file, text).expect("a copy can be written");
    render_by(command(name).env("SHADERS", folder.path()), size, arguments).picture
}

/// The mean of values, with four standard errors, which are exceeded at random once in 16,000 times.
pub struct Estimate {
    pub mean: f64,
    pub confidence: f64,
}

impl Estimate {
    pub fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Self { mean, confidence: 4.0 * (squares / (count - 1.0) / count).sqrt() }
    }
}

/// One number per pixel: the mean of its colours.
pub fn brightness(picture: &Picture) -> Vec<f64> {
    let mean = |pixel: &[f32; 4]| pixel[..3].iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0;
    picture.pixels.iter().map(mean).collect()
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(4).repeats();
}

/// A model without microfacets.
#[test]
fn other_materials_look_as_in_11() {
    let picture = |name: &str| {
        let sets = ["sun azimuth=150", "sun elevation=24", "camera eye=3,4,7"];
        Chapter::new(name).scene("samples/assets/chess.obj").sets(&sets).frames(2).picture()
    };
    let [other, own] = ["11_path_tracing", NAME].map(picture);
    same_colors("11 and 45 without microfacets", NAME, &other, &own);
}

/// The difference of two pictures by random numbers of their own: its mean, and four standard errors.
pub fn difference(one: &Picture, other: &Picture) -> Estimate {
    let pairs = brightness(one).into_iter().zip(brightness(other));
    Estimate::of(&pairs.map(|(one, other)| one - other).collect::<Vec<_>>())
}

/// 2^20 samples in all under the day's sky, without compensation: its part of the light is not sampled by facets.
#[test]
fn three_ways_to_choose_facets_have_one_mean() {
    let day = |sets: &[&str]| {
        let common = ["scene=spheres", "sky=day", "compensation=off", "roughness=0.5"];
        chapter("128x64").frames(128).sets(&common).sets(sets)
    };
    let [distribution, visible, bounded] = [
        day(&["sampling=distribution", "seed=0"]).picture(),
        day(&["sampling=visible", "seed=1"]).picture(),
        day(&["sampling=bounded", "seed=2"]).picture(),
    ];
    for (name, other) in [("distribution", &distribution), ("bounded", &bounded)] {
        let Estimate { mean, confidence } = difference(other, &visible);
        println!("{name} - visible: {mean:.6} ± {confidence:.6}");
        assert!(mean.abs() < confidence, "{name} - visible: {mean} ± {confidence}");
    }
    let shaders = shaders_with(
        "common/microfacet.glsl",
        "surface.roughness = roughness;",
        "roughness += 0.02; surface.alpha = roughness * roughness; surface.roughness = roughness;",
    );
    let rougher = day(&["sampling=bounded", "seed=2"]).shaders(shaders.path()).picture();
    let Estimate { mean, confidence } = difference(&rougher, &visible);
    println!("rougher - visible: {mean:.6} ± {confidence:.6}");
    assert!(mean.abs() > confidence, "a roughness wrong by 0.02 passes: {mean} ± {confidence}");
}

/// `sets` as the arguments of a run.
fn set(sets: &[&str]) -> Vec<String> {
    set_arguments(sets).into_iter().map(str::to_owned).collect()
}
