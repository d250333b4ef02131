//! `--pixel`: the printed numbers equal those of the picture, bit for bit.

use std::path::Path;

use common::app::Picture;
use run::{command, copy_of_shaders, render_by};

const SIZE: &str = "48x30";
/// A pixel that shows a piece in 05 and 06.
const PIXEL: [usize; 2] = [24, 20];

/// Output of `--pixel`.
fn printed(shaders: &Path, name: &str) -> String {
    let [x, y] = PIXEL;
    let mut sample = command(name);
    sample.env("SHADERS", shaders).args(["--size", SIZE, "--pixel", &format!("{x},{y}")]);
    let output = sample.output().expect("the sample starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && errors.is_empty(), "{name}: {errors}");
    String::from_utf8(output.stdout).expect("the text is UTF-8")
}

/// The decimal numbers of the row with this name, for each ray in order.
fn rows(text: &str, name: &str) -> Vec<Vec<f32>> {
    let row = |line: &str| {
        let rest = line.trim_start().strip_prefix(name)?.trim_start();
        // A hit without a shader call has no numbers.
        let (decimal, _) = rest.trim_start_matches("t ").split_once(" = ")?;
        Some(decimal.split(", ").map(|number| number.parse().expect("a number")).collect())
    };
    text.lines().filter_map(row).collect()
}

fn pixel_of(shaders: &Path, name: &str, view: &str) -> [f32; 4] {
    let mut sample = command(name);
    let Picture { width, pixels, .. } =
        render_by(sample.env("SHADERS", shaders), SIZE, &["--set", view]).picture;
    pixels[PIXEL[1] * width as usize + PIXEL[0]]
}

#[test]
fn the_rays_of_a_pixel_are_those_of_the_picture() {
    let shaders = copy_of_shaders();
    let shade = shaders.path().join("06_reflection/shade.rchit");
    let text = std::fs::read_to_string(&shade).expect("a shader");
    let printing = "void main() {\n    PRINT(\"t is %f\", gl_HitTEXT);";
    std::fs::write(&shade, text.replace("void main() {", printing)).expect("an edit");
    for name in ["05_shadow_miss", "06_reflection"] {
        let view = |view| pixel_of(shaders.path(), name, view);
        let [custom, _, t, _] = view("show=hit");
        let direction = view("show=ray direction");
        let [x, y, z, lit] = view("show=shadow origin");

        let text = printed(shaders.path(), name);
        assert!(text.starts_with(&format!("{name} · frame 0 · pixel 24,20 of 48x30\n")), "{text}");
        assert_eq!(rows(&text, "direction")[0], direction[..3], "{text}");
        assert_eq!(rows(&text, "hit")[0], [t], "{text}");
        assert!(text.contains(&format!(" · custom index {custom} · ")), "{text}");
        assert_eq!(rows(&text, "origin")[1], [x, y, z], "{text}");
        let shadow = text.split("ray 2 · ").nth(1).expect("a shadow ray");
        let shadow = shadow.split("ray 3").next().unwrap_or(shadow);
        assert_eq!(shadow.contains("miss       shadow.rmiss"), lit == 1.0, "{text}");
        let prints = text.lines().filter(|line| line.contains("PRINT      t is "));
        let hits = rows(&text, "hit").len();
        assert_eq!(prints.count(), if name == "06_reflection" { hits } else { 0 }, "{text}");
    }
}

#[test]
fn what_traces_and_prints_nothing_is_told_so() {
    run::needs!("16_ray_query");
    let (code, line) = run::refused("16_ray_query", &["--size", SIZE, "--pixel", "3,4"]);
    let nothing = "no shader called traceRayEXT or printed anything for pixel 3,4, and the rays of a rayQueryEXT \
                   are not recorded: write PRINT(";
    assert!(code == 1 && line.contains(nothing), "{line}");
}

#[test]
fn of_several_passes_the_first_is_told_and_the_others_are_named() {
    for (name, passes) in [
        ("31_history_and_filter", "(history, variance, filter, compose)"),
        ("32_reservoirs", "(time, space)"),
    ] {
        let mut sample = command(name);
        let output = sample.args(["--size", SIZE, "--pixel", "24,20"]).output().expect("it starts");
        let text = String::from_utf8_lossy(&output.stdout);
        let last = text.lines().last().unwrap_or_default();
        assert!(text.contains("ray 1 · "), "{text}");
        assert!(
            last.contains("the rays of the first pass alone") && last.contains(passes),
            "{text}"
        );
    }
}
