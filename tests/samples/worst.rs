//! Every chapter in the worst conforming arithmetic: finite pictures, close to the driver's own.

use common::app::Picture;
use run::{Near, Run, bits, flip, has_worst_arithmetic, render, same_colors, set_arguments};

const SIZE: &str = "96x60";

fn number(chapter: &str) -> u32 {
    chapter[..2].parse().expect("a chapter begins with its number")
}

/// Returns whether a picture of random paths equals the driver's own, except for one path in a hundred at
/// each surface of a path.
///
/// A path that hits an edge, or makes one choice differently, continues differently from there on. It is then
/// as far from the driver's path as another draw of random numbers would be, and a picture with another seed
/// shows how far that is. So the mean FLIP, divided by the mean FLIP of the other seed, is the fraction of
/// the paths that changed. If this fraction is larger, errors have more than random effects.
fn paths_are_the_same(chapter: &str, surfaces: f32, driver: &Picture, worst: &Picture) -> bool {
    let other = rendered(chapter, "driver", &["--set", "seed=1"]).picture;
    let (mean, drawn_anew) = (flip(driver, worst).0, flip(driver, &other).0);
    println!("{chapter}: another seed has a mean FLIP of {drawn_anew:.5}");
    mean <= 0.01 * surfaces * drawn_anew
}

fn rendered(name: &str, arithmetic: &str, arguments: &[&str]) -> Run {
    let run = render(name, SIZE, &[arguments, &["--arithmetic", arithmetic]].concat());
    assert_eq!(run.report["arithmetic"], arithmetic);
    let mut values = run.picture.pixels.iter().flatten();
    assert!(values.all(|value| value.is_finite()), "{name}, {arithmetic}: NaN or infinity");
    run
}

/// A chapter of each kind: only the nearest hit decides, or also a shadow ray, or an intersection shader.
const OF_EACH_KIND: [&str; 3] = ["02_basic", "05_shadow_miss", "08_intersection"];

fn pictures_are_finite_and_near(arithmetic: &str, wanted: impl Fn(&str) -> bool) {
    if !has_worst_arithmetic() {
        return;
    }
    let mut wrong = Vec::new();
    for name in run::chapters_on_the_framework().into_iter().filter(|name| wanted(name)) {
        // The initial picture of 24 shows the errors of a rung that has many.
        let set: &[&str] = match &name[..] {
            // Nothing moves in its first frame.
            "23_motion_blur" => &["--set", "frame=934", "--set", "shutter=2", "--set", "samples=2"],
            "24_accuracy" => &["--set", "show=picture", "--set", "rung=two-float"],
            _ => &[],
        };
        let driver = rendered(&name, "driver", set).picture;
        let worst = rendered(&name, arithmetic, set).picture;
        let (mean, outliers) = flip(&driver, &worst);
        println!("{name} {arithmetic}: mean FLIP {mean:.5}, {:.2} % outliers", 100.0 * outliers);
        assert_ne!(bits(&driver), bits(&worst), "{name}: nothing was rewritten");
        let is_near = match number(&name) {
            // About four bounces between pieces; or twenty walls of glass, most of them round.
            11 | 29 | 45 => paths_are_the_same(&name, 5.0, &driver, &worst),
            27 => paths_are_the_same(&name, 20.0, &driver, &worst),
            _ => Near::of(&name).holds(&driver, &worst),
        };
        if !is_near {
            wrong.push(format!("{name}: mean {mean}, outliers {outliers}"));
        }
    }
    assert!(wrong.is_empty(), "{arithmetic}: {wrong:?}");
}

/// One of each kind, and those whose shaders have been edited since the last commit.
#[test]
fn pictures_are_finite_and_near_the_drivers_own() {
    let changed = run::changed();
    pictures_are_finite_and_near("worst", |name| {
        let shaders = format!("shaders/{name}/");
        OF_EACH_KIND.contains(&name) || changed.iter().any(|file| file.starts_with(&shaders))
    });
}

#[test]
#[ignore = "nightly: every chapter; quick: worst::pictures_are_finite_and_near_the_drivers_own"]
fn every_picture_is_finite_and_near_the_drivers_own() {
    pictures_are_finite_and_near("worst", |_| true);
}

#[test]
#[ignore = "nightly: every chapter; quick: worst::pictures_are_finite_and_near_the_drivers_own"]
fn so_it_is_where_copies_of_a_formula_disagree() {
    pictures_are_finite_and_near("worst-by-place", |_| true);
}

#[test]
#[ignore = "nightly: compiles for long; quick: reflection::a_loop_and_recursion_give_the_same_picture"]
fn a_loop_and_recursion_agree() {
    if !has_worst_arithmetic() {
        return;
    }
    let method = |arithmetic, method: &str| {
        rendered("06_reflection", arithmetic, &["--set", &format!("method={method}")]).picture
    };
    let [by_loop, by_recursion] = ["iterative", "recursive"].map(|m| method("worst", m));
    same_colors("06 by a loop and by recursion, worst", "06", &by_loop, &by_recursion);
    let [by_loop, by_recursion] = ["iterative", "recursive"].map(|m| method("worst-by-place", m));
    let is_near = Near::of("06").holds(&by_loop, &by_recursion);
    assert!(is_near, "{:?}", flip(&by_loop, &by_recursion));
}

#[test]
#[ignore = "nightly: compiles for long; quick: scene_effects every_scene_has_its_stages_and_looks_the_same_with_all_of_them"]
fn a_specialised_pipeline_and_one_of_everything_agree() {
    if !has_worst_arithmetic() {
        return;
    }
    let pipeline = |arithmetic, pipeline: &str| {
        let set = format!("pipeline={pipeline}");
        rendered("25_scene_effects", arithmetic, &["--set", &set]).picture
    };
    let [own, everything] = ["specialised", "everything"].map(|p| pipeline("worst", p));
    same_colors("25's own pipeline and everything, worst", "25", &own, &everything);
    let [own, everything] = ["specialised", "everything"].map(|p| pipeline("worst-by-place", p));
    assert!(Near::of("25").holds(&own, &everything), "{:?}", flip(&own, &everything));
}

/// A device may pass a triangle twice to any-hit shaders, unless that is disallowed: the list of 03 shows it.
#[test]
fn a_triangle_is_offered_twice_unless_that_is_ruled_out() {
    if !has_worst_arithmetic() {
        return;
    }
    let layer = |layer: &str, no_duplicates: &str| {
        let sets = ["mode=all hits", "show=triangle", layer, no_duplicates];
        bits(&rendered("03_any_hit", "worst", &set_arguments(&sets)).picture)
    };
    let [first, second, third] =
        ["layer=0", "layer=1", "layer=2"].map(|name| layer(name, "no duplicates=off"));
    assert!(first == second, "the first surface is not in the list twice");
    assert!(layer("layer=0", "no duplicates=on") == first);
    assert!(layer("layer=1", "no duplicates=on") == third, "the second surface");
}

/// A device may call the intersection shader for rays that miss its box: the rung of 42 that takes every call
/// for a hit sees more spheres, and the rungs that test the sphere see the right ones.
#[test]
fn a_shader_that_trusts_its_box_is_found_out() {
    if !has_worst_arithmetic() {
        return;
    }
    let pictures = |rung: &str| {
        let set = format!("sphere rung={rung}");
        ["driver", "worst"].map(|arithmetic| {
            let arguments = ["--set", "scene=chess", "--set", &set, "--set", "show=hit"];
            rendered("42_distant_spheres", arithmetic, &arguments).picture
        })
    };
    let hits = |picture: &Picture, others: &Picture| {
        let pairs = picture.pixels.iter().zip(&others.pixels);
        pairs.filter(|(a, b)| a[..2] != b[..2]).count()
    };
    let [driver, worst] = pictures("offered");
    assert!(hits(&driver, &worst) > 200, "{}", hits(&driver, &worst));
    let [driver, worst] = pictures("stable");
    assert!(hits(&driver, &worst) <= 2, "{}", hits(&driver, &worst));
}
