//! Every chapter in the worst arithmetic that conforms: finite pictures, near the driver's own.

use run::{Run, bits, flip, render, root};

const SIZE: &str = "96x60";

/// The largest mean FLIP, and the largest share of pixels above 0.1. A colour off by one step of 255 has a
/// FLIP of about 0.005; of 5,760 pixels, 12 may see the other of two surfaces that meet at an edge.
const BOUNDS: (f32, f32) = (0.005, 0.002);

fn chapters() -> Vec<String> {
    let entries = std::fs::read_dir(root().join("samples")).expect("the samples are there");
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    // 01 is one file, and has no such switch.
    let is_chapter = |name: &String| name.as_bytes()[0].is_ascii_digit() && !name.starts_with("01");
    let mut names: Vec<String> = names.filter(is_chapter).collect();
    names.sort();
    assert!(names.len() >= 14, "{names:?}");
    names
}

fn rendered(name: &str, arithmetic: &str, arguments: &[&str]) -> Run {
    let run = render(name, SIZE, &[arguments, &["--arithmetic", arithmetic]].concat());
    assert_eq!(run.report["arithmetic"], arithmetic);
    let mut values = run.picture.pixels.iter().flatten();
    assert!(values.all(|value| value.is_finite()), "{name}, {arithmetic}: NaN or infinity");
    run
}

fn every_picture_is_finite_and_near(arithmetic: &str) {
    let mut wrong = Vec::new();
    for name in chapters() {
        // The picture that 24 begins with is one of errors, of a rung that has many.
        let set: &[&str] = match &name[..] {
            "24_accuracy" => &["--set", "show=picture", "--set", "rung=two-float"],
            _ => &[],
        };
        let driver = rendered(&name, "driver", set).picture;
        let worst = rendered(&name, arithmetic, set).picture;
        let (mean, outliers) = flip(&driver, &worst);
        println!("{name} {arithmetic}: mean FLIP {mean:.5}, {:.2} % outliers", 100.0 * outliers);
        assert_ne!(bits(&driver), bits(&worst), "{name}: nothing was rewritten");
        if mean > BOUNDS.0 || outliers > BOUNDS.1 {
            wrong.push(format!("{name}: mean {mean}, outliers {outliers}"));
        }
    }
    assert!(wrong.is_empty(), "{arithmetic}: {wrong:?}");
}

#[test]
fn every_picture_is_finite_and_near_the_drivers_own() {
    every_picture_is_finite_and_near("worst");
}

#[test]
fn so_it_is_where_copies_of_a_formula_disagree() {
    every_picture_is_finite_and_near("worst-by-place");
}

#[test]
fn a_loop_and_recursion_agree() {
    let method = |arithmetic, method: &str| {
        rendered("06_reflection", arithmetic, &["--set", &format!("method={method}")]).picture
    };
    let [by_loop, by_recursion] = ["iterative", "recursive"].map(|m| method("worst", m));
    assert!(bits(&by_loop) == bits(&by_recursion), "{:?}", flip(&by_loop, &by_recursion));
    let [by_loop, by_recursion] = ["iterative", "recursive"].map(|m| method("worst-by-place", m));
    let (mean, outliers) = flip(&by_loop, &by_recursion);
    assert!(mean <= BOUNDS.0 && outliers <= BOUNDS.1, "mean {mean}, outliers {outliers}");
}

#[test]
fn a_specialised_pipeline_and_one_of_everything_agree() {
    let pipeline = |arithmetic, pipeline: &str| {
        let set = format!("pipeline={pipeline}");
        rendered("25_scene_effects", arithmetic, &["--set", &set]).picture
    };
    let [own, everything] = ["specialised", "everything"].map(|p| pipeline("worst", p));
    assert!(bits(&own) == bits(&everything), "{:?}", flip(&own, &everything));
    let [own, everything] = ["specialised", "everything"].map(|p| pipeline("worst-by-place", p));
    let (mean, outliers) = flip(&own, &everything);
    assert!(mean <= BOUNDS.0 && outliers <= BOUNDS.1, "mean {mean}, outliers {outliers}");
}

/// A device may offer a triangle twice, unless that is ruled out: the list of 03 shows it.
#[test]
fn a_triangle_is_offered_twice_unless_that_is_ruled_out() {
    let layer = |layer: &str, no_duplicates: &str| {
        let sets = ["mode=all hits", "show=triangle", layer, no_duplicates];
        let arguments: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
        bits(&rendered("03_any_hit", "worst", &arguments).picture)
    };
    let [first, second, third] =
        ["layer=0", "layer=1", "layer=2"].map(|name| layer(name, "no duplicates=off"));
    assert!(first == second, "the first surface is not in the list twice");
    assert!(layer("layer=0", "no duplicates=on") == first);
    assert!(layer("layer=1", "no duplicates=on") == third, "the second surface");
}
