//! 02_basic: the picture, and primary visibility held to the reference pixel by pixel.

use common::scene::Scene;

use run::primary_hits::{answer, judge, rays, reference};
use run::{bits, golden, render};

const SIZE: &str = "240x150";

#[test]
fn the_picture_is_the_golden_one() {
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden and repeats it to the bit.
    golden("02_basic", &render("02_basic", SIZE, &[]).picture, 0.002);
}

#[test]
fn two_runs_give_the_same_bits() {
    let [first, second] = [0, 1].map(|_| render("02_basic", SIZE, &[]));
    assert_eq!(bits(&first.picture), bits(&second.picture));
}

#[test]
fn every_hit_agrees_with_the_reference() {
    let scene = Scene::chess().unwrap();
    let hits = render("02_basic", SIZE, &["--set", "show=hit"]).picture;
    let directions = render("02_basic", SIZE, &["--set", "show=ray direction"]).picture;
    let answers = hits.pixels.iter().map(answer);
    let tally = judge(&reference(&scene), rays(&scene.camera, &directions).zip(answers));
    println!("{tally}");
    assert_eq!(tally.wrong, 0, "{:?}", tally.first_wrong);
    // Edges are thin: where more than one ray in five hundred needs an excuse, something is wrong.
    assert!(tally.ties + tally.grazes < hits.pixels.len() / 500, "{tally}");
    // The scene is no empty sky: most rays must have met something.
    assert!(hits.pixels.iter().filter(|pixel| pixel[2] > 0.0).count() > hits.pixels.len() / 2);
}
