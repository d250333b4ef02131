//! Pictures that are made larger than a page shows them, so that their edges are smooth.
//!
//! Most chapters trace one ray per pixel. A picture of 1920 by 1200 that is shown as 960 by 600 has four.

use common::app::Picture;

/// The width of a picture on a page, in pixels.
const WIDTH: u32 = 960;

/// The size of a run's picture over its size on the page, in each direction: a whole number. One that moves is not
/// shrunk.
pub fn times(arguments: &[String]) -> u32 {
    if arguments.iter().any(|word| word == "--animate") {
        return 1;
    }
    let size = arguments.iter().position(|word| word == "--size");
    let size = size.and_then(|index| arguments.get(index + 1)?.split_once('x'));
    let Some(width) = size.and_then(|(width, _)| width.parse::<u32>().ok()) else { return 1 };
    if width.is_multiple_of(WIDTH) { (width / WIDTH).max(1) } else { 1 }
}

/// Replaces each square of pixels by its mean; what does not fill a square is left out.
///
/// A pixel counts as no more than white, as on a screen: else one bright glint would hide its neighbours.
pub fn shrunk(picture: &Picture, times: u32) -> Picture {
    let (width, height) = (picture.width / times, picture.height / times);
    let mean = |(x, y): (u32, u32)| {
        let square = (0..times * times).map(|i| (x * times + i % times, y * times + i / times));
        let sum = square.fold([0.0; 4], |sum: [f32; 4], (x, y)| {
            let pixel = picture.pixels[(y * picture.width + x) as usize];
            std::array::from_fn(|channel| sum[channel] + pixel[channel].clamp(0.0, 1.0))
        });
        sum.map(|sum| sum / (times * times) as f32)
    };
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    Picture { width, height, pixels: places.map(mean).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_whole_number_of_times_too_wide_is_shrunk() {
        let of = |size: &str| times(&["--headless", "--size", size].map(str::to_owned));
        let sizes = ["960x600", "1920x1200", "2880x900", "1000x600", "480x300", "x", "0x0"];
        assert_eq!(sizes.map(of), [1, 2, 3, 1, 1, 1, 1]);
        assert_eq!(times(&["--size".to_owned()]), 1);
        assert_eq!(times(&["--size", "1920x1200", "--animate"].map(str::to_owned)), 1);
    }

    #[test]
    fn a_square_becomes_its_mean_and_a_glint_no_more_than_white() {
        let grey = |value: f32| [value, value, value, 1.0];
        let pixels = [0.0, 40.0, 0.5, 9.0, 0.5, 0.0, 0.5, 9.0].map(grey).to_vec();
        let small = shrunk(&Picture { width: 4, height: 2, pixels }, 2);
        let (first, second) = ((0.0 + 1.0 + 0.5 + 0.0) / 4.0, (0.5 + 1.0 + 0.5 + 1.0) / 4.0);
        let pixels = vec![grey(first), grey(second)];
        assert_eq!(small, Picture { width: 2, height: 1, pixels });
    }
}
