//! The difference between two pictures.

use common::app::Picture;

/// The mean difference of all channels after conversion to PNG, from 0 to 1.
pub fn mean_difference(a: &Picture, b: &Picture) -> f64 {
    let (a, b) = (a.srgb(), b.srgb());
    let sum: u64 = a.iter().zip(&b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / 255.0 / a.len().max(1) as f64
}

/// The number of pixels that differ after conversion to PNG.
pub fn pixels_apart(a: &Picture, b: &Picture) -> usize {
    let (a, b) = (a.srgb(), b.srgb());
    a.chunks(3).zip(b.chunks(3)).filter(|(a, b)| a != b).count()
}

/// The numbers of pixels darker and brighter than another picture's after conversion to PNG; one that only
/// changes its colour counts as darker.
pub fn darker_and_brighter(own: &Picture, other: &Picture) -> (usize, usize) {
    let (own, other) = (own.srgb(), other.srgb());
    let sum = |pixel: &[u8]| pixel.iter().map(|c| u32::from(*c)).sum::<u32>();
    let apart = own.chunks(3).zip(other.chunks(3)).filter(|(a, b)| a != b);
    apart.fold((0, 0), |(darker, brighter), (a, b)| {
        if sum(a) <= sum(b) { (darker + 1, brighter) } else { (darker, brighter + 1) }
    })
}

/// A picture that marks the pixels that differ between two of one size in red, over a faint copy of the
/// first.
pub fn marked(own: &Picture, other: &Picture) -> Picture {
    let pairs =
        own.srgb().chunks(3).zip(other.srgb().chunks(3)).map(|(a, b)| a != b).collect::<Vec<_>>();
    let paint = |(pixel, apart): (&[f32; 4], bool)| {
        if apart {
            [1.0, 0.0, 0.0, 1.0]
        } else {
            let grey = 0.25 * (pixel[0] + pixel[1] + pixel[2]).clamp(0.0, 3.0) / 3.0;
            [grey, grey, grey, 1.0]
        }
    };
    let pixels = own.pixels.iter().zip(pairs).map(paint).collect();
    Picture { width: own.width, height: own.height, pixels }
}

/// Compares two pictures bit by bit.
pub fn same_bits(a: &Picture, b: &Picture) -> bool {
    let bits = |picture: &Picture| -> Vec<[u32; 4]> {
        picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
    };
    (a.width, a.height) == (b.width, b.height) && bits(a) == bits(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_and_white_are_one_apart() {
        let plain = |value| Picture { width: 3, height: 2, pixels: vec![[value; 4]; 6] };
        assert_eq!(mean_difference(&plain(0.0), &plain(1.0)), 1.0);
        assert_eq!(mean_difference(&plain(0.3), &plain(0.3)), 0.0);
        let mut spot = plain(0.3);
        spot.pixels[4][1] = 0.7;
        assert_eq!(pixels_apart(&plain(0.3), &spot), 1);
        // Less than a step of 1/255: another float, the same pixel of a PNG.
        spot.pixels[4][1] = 0.300_000_1;
        assert_eq!(pixels_apart(&plain(0.3), &spot), 0);
        assert!(!same_bits(&plain(0.3), &spot) && same_bits(&spot, &spot));
    }

    #[test]
    fn where_and_how_pictures_differ_is_told() {
        let plain = Picture { width: 3, height: 1, pixels: vec![[0.3; 4]; 3] };
        let mut own = plain.clone();
        (own.pixels[0][1], own.pixels[2][1]) = (0.1, 0.7);
        assert_eq!(darker_and_brighter(&own, &plain), (1, 1));
        let marked = marked(&own, &plain);
        let red = [1.0, 0.0, 0.0, 1.0];
        assert_eq!([0, 1, 2].map(|at| marked.pixels[at] == red), [true, false, true]);
    }
}
