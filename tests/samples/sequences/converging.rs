//! The benefit of further samples: the speed at which the error falls, and its spread over neighbours.

use common::app::Picture;

use super::{SIZE, SMALL, chapter, error};

/// The error after these numbers of samples.
#[derive(Debug)]
struct Errors {
    after_16: f64,
    after_64: f64,
    after_256: f64,
}

#[test]
#[ignore = "nightly: 1,024 samples per pixel; quick: sequences::each_box_of_a_scrambled_net_holds_one_point"]
fn every_sequence_converges_to_one_picture_and_the_even_ones_sooner() {
    let reference = chapter(SMALL).frames(1024).sets(&["seed=1"]).picture();
    let errors = |sequence: &str, scrambling: &str| {
        let settings = [&format!("sequence={sequence}"), &format!("scrambling={scrambling}")];
        let after = |frames| {
            error(
                &chapter(SMALL).frames(frames).sets(&settings.map(|s| s as &str)).picture(),
                &reference,
            )
        };
        Errors { after_16: after(16), after_64: after(64), after_256: after(256) }
    };
    let random = errors("random", "Owen");
    println!("random: {random:.5?}");
    // Independent samples: four times as many halve the error.
    for ratio in [random.after_16 / random.after_64, random.after_64 / random.after_256] {
        assert!((1.7..2.4).contains(&ratio), "random: {random:?}");
    }
    for (sequence, scrambling) in [("Halton", "rotation"), ("R2", "rotation"), ("Sobol", "Owen")] {
        let even = errors(sequence, scrambling);
        println!("{sequence}: {even:.5?}");
        // At an edge, the error of patterned points falls as N^-3/4 (Mitchell 1996): sixteen times as many
        // divide it by eight, whereas random ones divide it by four.
        assert!(even.after_16 / even.after_256 > 5.5, "{sequence}: {even:?}");
        assert!(even.after_64 < random.after_64 / 2.0, "{sequence} {even:?}, random {random:?}");
    }
}

#[test]
#[ignore = "nightly: many frames; quick: sequences::neighbours_have_their_points_in_common_only_without_scrambling"]
fn errors_of_scrambled_pixels_cancel_and_shared_ones_do_not() {
    let reference = chapter(SIZE).frames(256).sets(&["seed=1", "filter=box"]).picture();
    let blocks = |scrambling: &str| {
        let picture =
            chapter(SIZE).frames(4).sets(&["filter=box"]).set("scrambling", scrambling).picture();
        let [pixels, blocks] =
            [1, 8].map(|side| error(&shrunk(&picture, side), &shrunk(&reference, side)));
        println!("{scrambling}: {pixels:.5} of pixels, {blocks:.5} of blocks");
        pixels / blocks
    };
    let (shared, scrambled) = (blocks("none"), blocks("Owen"));
    // The mean of 64 independent errors is an eighth of one.
    assert!((6.0..10.0).contains(&scrambled), "{scrambled}");
    assert!(shared < 5.5, "{shared}");
}

/// Each square of pixels replaced by its mean; incomplete squares are left out.
pub fn shrunk(picture: &Picture, side: u32) -> Picture {
    let (width, height) = (picture.width / side, picture.height / side);
    let mean = |i: u32| {
        let mut sum = [0.0; 4];
        for j in 0..side * side {
            let (x, y) = (i % width * side + j % side, i / width * side + j / side);
            let pixel = picture.pixels[(y * picture.width + x) as usize];
            sum = [0, 1, 2, 3].map(|c| sum[c] + pixel[c] / (side * side) as f32);
        }
        sum
    };
    Picture { width, height, pixels: (0..width * height).map(mean).collect() }
}
