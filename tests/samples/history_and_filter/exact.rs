//! Constant light stays constant, the filter makes no light, and a still history is the mean of its frames.

use std::fs;

use tempfile::TempDir;

use super::{NAME, SIZE, chapter, colors, error, mean, reference};
use run::{Chapter, shaders_with};

/// Every path brings the same light, whose colours are no round numbers. Everything moves.
#[test]
fn constant_light_stays_constant_to_the_bit() {
    let traced = "float brightness = luminance(path.color);";
    let constant = format!("path.color = vec3(0.3, 0.7, 1.1);\n    {traced}");
    let shaders = shaders_with(&format!("{NAME}/camera.rgen"), traced, &constant);
    let moving = chapter().shaders(shaders.path()).sets(&["show=light", "depth=0"]);
    let picture = moving.frames(24).picture();
    for (at, pixel) in picture.pixels.iter().enumerate() {
        assert_eq!(pixel[..3], [0.3, 0.7, 1.1], "pixel {at}");
    }
}

/// A closed room whose surfaces shine with 1/2 and scatter 1/2 of what they receive: everywhere 1/2 + 1/4 + … = 1.
fn room() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let material = "newmtl half\nKd 0.5 0.5 0.5\nKe 0.5 0.5 0.5\nillum 1\n";
    fs::write(folder.path().join("room.mtl"), material).expect("the folder is writable");
    let corners = (0..8).map(|i: u32| {
        let [x, y, z] = [0, 1, 2].map(|bit| if i >> bit & 1 == 1 { 2 } else { -2 });
        format!("v {x} {y} {z}\n")
    });
    let sides =
        [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
    let sides = sides.map(|[a, b, c, d]| format!("f {a} {b} {c} {d}\n")).concat();
    let room = format!("mtllib room.mtl\nusemtl half\n{}{sides}", corners.collect::<String>());
    fs::write(folder.path().join("room.obj"), room).expect("the folder is writable");
    folder
}

fn in_room(folder: &TempDir) -> Chapter {
    let camera = ["camera eye=0.5,0.3,1.2", "camera target=-0.4,-0.3,-1", "field of view=70"];
    chapter().scene(folder.path().join("room.obj")).sets(&camera).set("motion", "camera")
}

/// The weight of two pixels is the same in both directions: what one gains the other loses.
#[test]
fn the_filter_makes_no_light_and_loses_none() {
    let folder = room();
    let sum = |passes: u32| {
        let picture = in_room(&folder).set("filter passes", passes).frames(3).picture();
        let deviation = mean(colors(&picture).map(|color| (color - 1.0).powi(2))).sqrt();
        (mean(colors(&picture)), deviation)
    };
    let [(before, noisy), (after, smooth)] = [0, 5].map(sum);
    println!("mean {before:.7} and {after:.7}, deviation {noisy:.4} and {smooth:.4}");
    // It does something.
    assert!(smooth < 0.3 * noisy, "{smooth} {noisy}");
    // Each of 5 passes adds 25 terms of at most 8 or so per pixel, each rounded to 2^-24 of itself.
    assert!((before - after).abs() < 125.0 * 8.0 * 2f64.powi(-24), "{before} {after}");
}

/// The mean of pictures with different seeds is 1, within four standard errors of theirs (six, as eight are few).
#[test]
fn history_and_filter_keep_the_light_of_a_room() {
    let folder = room();
    let means =
        (0..8).map(|seed| mean(colors(&in_room(&folder).set("seed", seed).frames(8).picture())));
    let means: Vec<f64> = means.collect();
    let middle = mean(means.iter().copied());
    let squares: f64 = means.iter().map(|mean| (mean - middle).powi(2)).sum();
    let bound = 6.0 * (squares / 7.0 / 8.0).sqrt();
    println!("{middle:.5} ± {bound:.5}");
    assert!((middle - 1.0).abs() < bound, "{middle} ± {bound}");
    assert!(bound < 0.02, "the test sees an error of 2 %: {bound}");
}

#[test]
fn a_still_history_is_the_mean_of_its_frames() {
    let still = chapter().set("motion", "still");
    let history = still.clone().set("memory", 255).set("filter passes", 0).frames(24).picture();
    let difference = error(&history, &reference(still, 0, 24));
    println!("{difference:.2e}");
    // The previous pixel is found with an error of 10^-4 pixels, and that part of each neighbour's light comes in.
    assert!(difference < 1e-3, "{difference}");
}

/// The first ray goes through the middle of a pixel here, and anywhere in 11: edges differ, and the mean does not.
#[test]
fn its_light_is_that_of_11() {
    let of = |chapter: Chapter, seed: u32| {
        let scene = chapter.size(SIZE).scene("samples/assets/box_on_plane.obj");
        scene.set("seed", seed).with(&["--samples", "0..32"]).picture()
    };
    let sets = ["history=off", "filter passes=0", "play=off", "motion=still"];
    let here = of(Chapter::new(NAME).sets(&sets), 0);
    let there = of(Chapter::new("11_path_tracing"), 1);
    let differences: Vec<f64> =
        colors(&here).zip(colors(&there)).map(|(here, there)| here - there).collect();
    let count = differences.len() as f64;
    let bias = mean(differences.iter().copied());
    let square = mean(differences.iter().map(|difference| difference.powi(2)));
    // Three colours of a pixel are not independent of each other.
    let bound = 4.0 * (square / (count / 3.0)).sqrt();
    println!("{bias:.5} ± {bound:.5} of {:.3}", mean(colors(&here)));
    assert!(bias.abs() < bound, "{bias} ± {bound}");
    assert!(bound < 0.02 * mean(colors(&here)), "the test sees an error of 2 %: {bound}");
}
