//! 02_basic: the picture, and primary visibility compared with the reference pixel by pixel.

use common::scene::Scene;
use serde_json::json;

use run::primary_hits::{answer, judge, rays, reference};
use run::{bits, expected, render};

const SIZE: &str = "240x150";

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
    expected::hold("02_basic/hits", tally.values());
    assert_eq!(tally.wrong, 0, "{:?}", tally.first_wrong);
    // Edges are thin: if more than one ray in five hundred needs an excuse, something is wrong.
    assert!(tally.ties + tally.grazes < hits.pixels.len() / 500, "{tally}");
    // A check that the scene is not an empty sky: most rays must hit something.
    assert!(hits.pixels.iter().filter(|pixel| pixel[2] > 0.0).count() > hits.pixels.len() / 2);
}

#[test]
fn pieces_are_instances_of_few_meshes() {
    let scene = Scene::chess().unwrap();
    expected::hold_exact("02_basic/scene", json!({ "instances": scene.instances.len() }));
    assert_eq!(scene.model.meshes.len(), 11);
}

/// The time of a frame with sorted triangles relative to one with triangles in the file's order.
#[test]
#[ignore = "by hand: takes times"]
fn the_order_of_the_triangles_in_time() {
    let time = |more: &[&str]| {
        let run = render("02_basic", "800x600", &[&["--frames", "5"], more].concat());
        run.report["gpu_milliseconds"]["min"].as_f64().unwrap()
    };
    let mut ratios: Vec<f64> = (0..20).map(|_| time(&[]) / time(&["--unordered"])).collect();
    ratios.sort_by(f64::total_cmp);
    let [low, ratio, high] = [5, 10, 15].map(|at| ratios[at]);
    println!("{ratio:.2}, middle half {low:.2} to {high:.2}");
    expected::give_timed("02_basic/order", json!({ "ratio": ratio, "low": low, "high": high }));
}
