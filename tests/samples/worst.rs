//! Every chapter in the worst arithmetic that conforms: finite pictures, near the driver's own.

use common::app::Picture;
use run::{Run, bits, flip, render};

const SIZE: &str = "96x60";

/// How far a chapter's picture may be from the driver's own: how many pixels may *flip*, that is, see the
/// other side of a decision, and the mean FLIP.
///
/// A ray's direction is off by some 4 ULP of 1, which is 7e-5 of a pixel of these pictures. An edge that
/// passes as near by a pixel's centre flips it: of 5,760 pixels less than one does, if all of them have an
/// edge, and so does a second decision, if its point is off by as little.
///
/// A colour is off where a texture is read elsewhere: weights off by 16 ULP of 1 are a thousandth of a texel
/// of 512, and a quarter of a step of 255 where black lies beside white. So at most a quarter of the pixels
/// change by a step, which has a FLIP of 0.005.
struct Near {
    flips: u32,
    mean: f32,
}

impl Near {
    /// # Panics
    /// If nothing is said of the chapter.
    fn of(chapter: &str) -> Self {
        match number(chapter) {
            // The nearest hit decides, and nothing else; lines fade out within a pixel (20).
            2 | 7 | 9 | 10 | 20 | 24 => Self { flips: 1, mean: 0.00125 },
            // A second decision: a hole or a random number (03), what a shadow ray meets (04 and later),
            // which of two faces of a solid is first (22), which cell of a lattice a point is in (13). Those
            // of rays to the sky move a colour by a sixteenth of the ambient light, a few steps of 255 (17).
            3 | 4 | 5 | 8 | 13 | 14 | 16 | 17 | 21 | 22 => Self { flips: 2, mean: 0.00125 },
            // Rays that round mirrors send on: an error grows by the way over the radius each time, and two
            // surfaces and more make a colour. Most of what they decide is dimmed by the mirrors' Fresnel
            // factor.
            6 | 12 | 26 => Self { flips: 2, mean: 0.0025 },
            // As before, and one decision more: Vulkan lets a sine be off by 2^-11, and so the direction of
            // a bounce in 25, and the place on the lens in 28. What such a ray meets moves a colour as much
            // as a shadow ray does.
            25 => Self { flips: 2, mean: 0.0025 + 0.00125 },
            28 => Self { flips: 2, mean: 0.00125 + 0.00125 },
            other => panic!("how near is a picture of {other}?"),
        }
    }

    /// Whether the pictures are as near as that. FLIP sees a picture as an eye does, blurred: one pixel that
    /// is another makes up to five that seem so.
    fn holds(&self, one: &Picture, other: &Picture) -> bool {
        let (mean, outliers) = flip(one, other);
        let flipped = outliers * one.pixels.len() as f32 / 5.0;
        mean <= self.mean && flipped <= self.flips as f32
    }
}

fn number(chapter: &str) -> u32 {
    chapter[..2].parse().expect("a chapter begins with its number")
}

/// Whether a picture of random paths is the driver's own, except for one path of a hundred at each surface
/// that a path meets.
///
/// A path that meets an edge, or makes one choice otherwise, goes elsewhere from there on. It is then as far
/// from the driver's path as another draw of random numbers would be, and a picture of another seed tells how
/// far that is. So the mean FLIP, divided by the mean FLIP of the other seed, is the part of the paths that
/// went elsewhere. If this part is larger, errors count for more than chance.
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

fn every_picture_is_finite_and_near(arithmetic: &str) {
    let mut wrong = Vec::new();
    for name in run::chapters_on_the_framework() {
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
        let is_near = match number(&name) {
            // Some four turns between pieces; or twenty walls of glass, most of them round.
            11 | 29 => paths_are_the_same(&name, 5.0, &driver, &worst),
            27 => paths_are_the_same(&name, 20.0, &driver, &worst),
            _ => Near::of(&name).holds(&driver, &worst),
        };
        if !is_near {
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
    let is_near = Near::of("06").holds(&by_loop, &by_recursion);
    assert!(is_near, "{:?}", flip(&by_loop, &by_recursion));
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
    assert!(Near::of("25").holds(&own, &everything), "{:?}", flip(&own, &everything));
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

/// A device may offer a sphere to rays that pass by its box: the rung of 08 that takes every offer for a hit
/// sees more of them, and the rungs that test the sphere see the right ones.
#[test]
fn a_shader_that_trusts_its_box_is_found_out() {
    let pictures = |rung: &str| {
        let set = format!("sphere rung={rung}");
        ["driver", "worst"].map(|arithmetic| {
            rendered("08_intersection", arithmetic, &["--set", &set, "--set", "show=hit"]).picture
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
