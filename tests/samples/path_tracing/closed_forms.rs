//! Scenes whose light has a closed form.

use std::f64::consts::PI;

use glam::DVec3;
use serde_json::json;

use super::{Estimate, brightness, chapter, picture_by_chance};
use run::{bits, expected};

/// The luminous square in the scene of each name.
pub const SQUARES: [(&str, [DVec3; 4]); 2] = [
    (
        "parallel squares",
        [
            DVec3::new(-0.5, -0.5, 1.0),
            DVec3::new(0.5, -0.5, 1.0),
            DVec3::new(0.5, 0.5, 1.0),
            DVec3::new(-0.5, 0.5, 1.0),
        ],
    ),
    (
        "perpendicular squares",
        [
            DVec3::new(-0.5, -0.5, 0.0),
            DVec3::new(-0.5, -0.5, 1.0),
            DVec3::new(0.5, -0.5, 1.0),
            DVec3::new(0.5, -0.5, 0.0),
        ],
    ),
];

/// The cosine-weighted fraction of the half-space above a point of the white square that a polygon fills: the
/// closed form of Lambert (Photometria, 1760), a sum over its edges.
pub fn form_factor(point: DVec3, polygon: &[DVec3; 4]) -> f64 {
    let to = polygon.map(|corner| (corner - point).normalize());
    let edges = (0..4).map(|i| {
        let (a, b) = (to[i], to[(i + 1) % 4]);
        let angle = a.dot(b).clamp(-1.0, 1.0).acos();
        angle * a.cross(b).try_normalize().unwrap_or(DVec3::ZERO).dot(DVec3::Z)
    });
    (edges.sum::<f64>() / (2.0 * PI)).abs()
}

/// The same for each pixel of a picture of `side` pixels that shows the whole white square.
pub fn form_factors(side: u32, polygon: &[DVec3; 4]) -> Vec<f64> {
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(side) - 0.5;
    let pixels = (0..side * side).map(|i| DVec3::new(place(i % side), -place(i / side), 0.0));
    pixels.map(|point| form_factor(point, polygon)).collect()
}

/// The form factors between the squares, in the closed form of textbooks (Howell, A Catalog of Radiation Heat
/// Transfer Configuration Factors, C-11 and C-14).
pub fn catalogued() -> [f64; 2] {
    let root = 2f64.sqrt();
    let parallel = (2.0 / PI)
        * ((4.0f64 / 3.0).sqrt().ln() + 2.0 * root * (1.0 / root).atan() - 2.0 * 1f64.atan());
    let perpendicular =
        (1.0 / PI) * (2.0 * 1f64.atan() - root * (1.0 / root).atan() + 0.25 * (3.0f64 / 4.0).ln());
    [parallel, perpendicular]
}

#[test]
fn the_closed_forms_agree() {
    for ((name, square), expected) in SQUARES.iter().zip(catalogued()) {
        let factors = form_factors(256, square);
        let mean = factors.iter().sum::<f64>() / factors.len() as f64;
        assert!((mean - expected).abs() < 2e-5, "{name}: {mean} {expected}");
    }
    assert!((catalogued()[0] - 0.199825).abs() < 1e-6 && (catalogued()[1] - 0.200044).abs() < 1e-6);
}

#[test]
fn squares_light_each_other_as_their_form_factors_say() {
    const SIDE: u32 = 64;
    const FRAMES: u32 = 64;
    for ((name, square), expected) in SQUARES.iter().zip(catalogued()) {
        let scene = format!("scene={name}");
        let shown = brightness(&picture_by_chance("64x64", FRAMES, &[&scene]));
        let factors = form_factors(SIDE, square);
        // Each sample is a coin toss: it hits the luminous square or not.
        let variance = |p: f64| p * (1.0 - p) / f64::from(FRAMES);
        let count = factors.len() as f64;
        let scores = shown.iter().zip(&factors).map(|(s, &p)| (s - p).powi(2) / variance(p));
        let mean_score = scores.sum::<f64>() / count;
        println!("{name}: mean square of the pixels' scores {mean_score:.4}");
        // The square of a score has mean 1 and variance about 2.
        assert!((mean_score - 1.0).abs() < 4.0 * (2.0 / count).sqrt(), "{name}: {mean_score}");
        let mean = shown.iter().sum::<f64>() / count;
        let confidence = 4.0 * (factors.iter().map(|&p| variance(p)).sum::<f64>()).sqrt() / count;
        println!("{name}: {mean:.5} ± {confidence:.5}, in closed form {expected:.5}");
        assert!((mean - expected).abs() < confidence, "{name}: {mean} not {expected}");
        let key = format!("11_path_tracing/{}", name.replace(' ', "_"));
        expected::hold(&key, json!({ "mean": mean, "closed": expected, "confidence": confidence }));
    }
}

#[test]
fn a_white_furnace_is_its_sky() {
    let sets = ["scene=furnace", "depth=256", "roulette=off"];
    let shown = chapter("96x60").frames(4).sets(&sets).picture();
    // Each path brings exactly 1, whatever way it takes: nothing is random or rounded.
    let grey = shown.pixels.iter().filter(|pixel| **pixel != [1.0; 4]).count();
    assert_eq!(grey, 0, "pixels of the furnace that are not white");
    // They are long enough for many bounces.
    let rays = chapter("96x60")
        .frames(1)
        .sets(&["scene=furnace", "depth=256", "roulette=off", "show=rays"])
        .picture();
    let longest = brightness(&rays).into_iter().fold(0.0, f64::max);
    println!("up to {longest} rays a path");
    assert!(longest > 15.0 && longest < 256.0, "{longest}");
}

#[test]
fn with_roulette_it_is_its_sky_within_the_confidence() {
    let shown =
        brightness(&chapter("96x60").frames(4).sets(&["scene=furnace", "depth=256"]).picture());
    let estimate = Estimate::of(&shown);
    estimate.is(1.0, "white furnace with roulette");
    assert!(estimate.confidence < 0.01);
}

#[test]
fn polish_creates_and_swallows_nothing() {
    for roulette in ["on", "off"] {
        let roulette = format!("roulette={roulette}");
        let sets = ["scene=polished furnace", "depth=256", &roulette];
        let estimate =
            Estimate::of(&brightness(&chapter("96x60").frames(16).sets(&sets).picture()));
        estimate.is(1.0, &format!("polished furnace, {roulette}"));
        assert!(estimate.confidence < 0.01);
    }
}

#[test]
fn a_depth_leaves_out_what_the_series_says() {
    for depth in [0, 1, 2, 5, 16] {
        let set = format!("depth={depth}");
        let shown =
            chapter("32x20").frames(2).sets(&["scene=closed room", "roulette=off", &set]).picture();
        // 1/2 + 1/4 + … + 1/2^(depth + 1), each exact in 32 bits.
        let expected = 1.0 - 0.5f32.powi(depth + 1);
        assert!(shown.pixels.iter().all(|pixel| pixel[..3] == [expected; 3]), "{depth}");
    }
}

/// The variance of one sample of the closed room with roulette, in closed form: see the page.
pub const ROOM_VARIANCE: f64 = 0.3125;

#[test]
fn roulette_ends_a_path_that_has_no_end_and_keeps_its_mean() {
    let sets = ["scene=closed room", "depth=256"];
    let estimate = Estimate::of(&brightness(&picture_by_chance("96x60", 4, &sets)));
    estimate.is(1.0, "closed room with roulette");
    let expected = (ROOM_VARIANCE / 4.0).sqrt();
    let off = (estimate.deviation / expected - 1.0).abs();
    assert!(off < 0.05, "the deviation is {}, not {expected}", estimate.deviation);
    let rays = picture_by_chance("96x60", 4, &[&sets[..], &["show=rays"]].concat());
    let rays = Estimate::of(&brightness(&rays));
    // Two rays, a third for a quarter of the paths, and for these another for each head of a coin.
    rays.is(2.5, "rays a path");
}

#[test]
fn a_seed_gives_other_paths_of_the_same_mean() {
    let of =
        |seed: &str| chapter("64x64").frames(16).sets(&["scene=parallel squares", seed]).picture();
    let [a, b] = ["seed=0", "seed=1"].map(of);
    assert_ne!(bits(&a), bits(&b));
    for shown in [a, b] {
        let mean = Estimate::of(&brightness(&shown)).mean;
        assert!((mean - catalogued()[0]).abs() < 4.0 * 0.4 / 256.0, "{mean}");
    }
}
