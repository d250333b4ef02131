//! 31_history_and_filter: what stays exact, where surfaces were, what lags behind, and what each part is good for.

mod cuts;
mod exact;
mod ghosts;
mod parts;
mod plots;
mod reprojection;

use common::app::Picture;
use run::Chapter;

const NAME: &str = "31_history_and_filter";
const SIZE: &str = "96x64";
/// One path per pixel and frame, shown as it is.
const PLAIN: [&str; 2] = ["history=off", "filter passes=0"];
/// Hard shadows of the sun alone: no random number has a part in them.
const NO_NOISE: [&str; 4] = ["light size=0", "sky=black", "depth=0", "filter passes=0"];

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

/// The mean of so many samples of a single moment.
fn reference(chapter: Chapter, frame: u32, samples: u32) -> Picture {
    let samples = format!("0..{samples}");
    let moment = [format!("frame={frame}"), "play=off".to_owned()];
    chapter.sets(&moment).sets(&PLAIN).with(&["--samples", &samples]).picture()
}

/// All colours of all pixels.
fn colors(picture: &Picture) -> impl Iterator<Item = f64> {
    picture.pixels.iter().flat_map(|pixel| [0, 1, 2].map(|k| f64::from(pixel[k])))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0.0, 0.0), |(count, sum), value| (count + 1.0, sum + value));
    sum / count
}

/// The root of the mean squared difference, over all pixels and colours.
fn error(a: &Picture, b: &Picture) -> f64 {
    mean(colors(a).zip(colors(b)).map(|(a, b)| (a - b).powi(2))).sqrt()
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(4).repeats();
}
