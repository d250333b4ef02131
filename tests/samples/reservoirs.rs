//! 32_reservoirs: every outcome on two pixels, the mean of many on a large picture, and what reuse costs and saves.

mod enumerated;
mod means;
mod model;
mod plots;
mod state;
mod tiny;

use common::app::Picture;
use run::Chapter;

const NAME: &str = "32_reservoirs";

fn chapter() -> Chapter {
    Chapter::new(NAME).size("64x40")
}

/// All colours of all pixels.
fn colors(picture: &Picture) -> impl Iterator<Item = f64> {
    picture.pixels.iter().flat_map(|pixel| [0, 1, 2].map(|k| f64::from(pixel[k])))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0.0, 0.0), |(count, sum), value| (count + 1.0, sum + value));
    sum / count
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(4).repeats();
}
