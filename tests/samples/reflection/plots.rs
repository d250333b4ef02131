//! Plots for the page of 06_reflection. Drawn on request: `cargo test --test samples
//! reflection::plots -- --ignored --nocapture`.

use common::app::Picture;
use serde_json::Map;

use super::chapter;
use run::expected;
use run::plot::{Shown, draw_panels};

#[test]
#[ignore = "by hand: draws docs/images/06_depths.png"]
fn depths() {
    let show = |depth: u32| {
        let close = ["camera target=-2.5,0.75,1.5", "field of view=16", "minimum contribution=0"];
        let shown = chapter("240x400").sets(&close).set("depth", depth).picture();
        (format!("depth {depth}"), shown)
    };
    draw_panels("06_depths.png", 1, &[Shown::row(&[0, 1, 2, 8].map(show))]);
}

/// The root mean square difference of two pictures on a screen, where nothing exceeds white.
fn error(a: &Picture, b: &Picture) -> f64 {
    let squares = a.pixels.iter().zip(&b.pixels).map(|(a, b)| {
        (0..3).map(|k| f64::from(a[k].min(1.0) - b[k].min(1.0)).powi(2)).sum::<f64>() / 3.0
    });
    (squares.sum::<f64>() / a.pixels.len() as f64).sqrt()
}

#[test]
#[ignore = "by hand: prints the error of each depth and of each minimum contribution"]
fn table_of_depths() {
    let show = |depth: u32, minimum: &str| {
        let minimum = format!("minimum contribution={minimum}");
        chapter("960x600").set("depth", depth).sets(&[&minimum]).picture()
    };
    let deepest = show(8, "0");
    let mut errors = Map::new();
    for depth in 0..=8 {
        let error = error(&show(depth, "0"), &deepest);
        println!("| {depth} | {error:.5} |");
        errors.insert(format!("depth.{depth}"), error.into());
    }
    for minimum in ["0", "0.001953125", "0.01", "0.05"] {
        let error = error(&show(8, minimum), &deepest);
        println!("| {minimum} | {error:.5} |");
        errors.insert(format!("minimum.{minimum}"), error.into());
    }
    let of = |name: &str| errors[name].as_f64().unwrap();
    let times = of("depth.4") / of("minimum.0.001953125");
    errors.insert("times".to_owned(), times.into());
    expected::hold("06_reflection/errors", errors.into());
}
