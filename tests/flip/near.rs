//! Bounds on the difference of two pictures whose pipelines differ, on a device that rounds as it likes.

use common::app::Picture;

/// Bounds on the difference of a picture from that of exact arithmetic: the number of decisions behind a pixel,
/// each of which may *flip*, and the mean FLIP.
///
/// A ray's direction is off by some 4 ULP of 1, which is 7e-5 of a pixel of a picture that is 96 wide. An edge
/// that passes as near by a pixel's centre, on either side, flips it: of 5,760 pixels less than one does, if all
/// of them have an edge, and so does a second decision, if its point is off by as little. In larger pictures
/// there are more pixels, and each is smaller.
///
/// A colour is off where a texture is read elsewhere: weights off by 16 ULP of 1 are a thousandth of a texel
/// of 512, and a quarter of a step of 255 where black lies beside white. So at most a quarter of the pixels
/// change by a step, which has a FLIP of 0.005.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    decisions: u32,
    /// The mean FLIP.
    pub mean: f32,
    /// Number of the two pictures that are not exact.
    off: u32,
}

impl Near {
    /// The bounds of a chapter's pictures, against one that is all but exact.
    ///
    /// # Panics
    /// If nothing is said of the chapter, as of those whose paths are random.
    pub fn of(chapter: &str) -> Self {
        Self::if_any(chapter).unwrap_or_else(|| panic!("how near is a picture of {chapter}?"))
    }

    /// The same, if anything is said of the chapter.
    pub fn if_any(chapter: &str) -> Option<Self> {
        let (decisions, mean) =
            match chapter[..2].parse().expect("a chapter begins with its number") {
                // The nearest hit decides, and nothing else; lines fade out within a pixel (20).
                1 | 2 | 7 | 9 | 10 | 20 | 24 => (1, 0.00125),
                // A second decision: a hole (03, 15) or a random number (03), what a shadow ray meets (04 and later),
                // which of two faces of a solid is first (22), which cell of a lattice a point is in (13). Those
                // of rays to the sky move a colour by a sixteenth of the ambient light, a few steps of 255 (17).
                3 | 4 | 5 | 8 | 13..=18 | 21..=23 | 30 | 34 | 36..=39 | 41 => (2, 0.00125),
                // Rays that round mirrors send on: an error grows by the way over the radius each time, and two
                // surfaces and more make a colour. Most of what they decide is dimmed by the mirrors' Fresnel
                // factor.
                6 | 12 | 26 => (2, 0.0025),
                // As before, and one decision more: Vulkan lets a sine be off by 2^-11, and so the direction of
                // a bounce in 25, and the place on the lens in 28 and on the light in 35. What such a ray meets
                // moves a colour as much as a shadow ray does.
                25 => (2, 0.0025 + 0.00125),
                28 | 35 => (2, 0.00125 + 0.00125),
                // Mip levels: a device makes each from the one before and rounds it to 8 bits, either way, so what
                // reads a level may be a step of 255 off. Half of the pixels of 19's picture read a texture, and three
                // quarters of 40's have another colour on an NVIDIA H200. llvmpipe's own pictures (240x150), with
                // these pixels a step brighter, are off by a mean FLIP of 0.0187 and 0.0260.
                19 => (2, 0.00125 + 0.0187),
                40 => (2, 0.00125 + 0.0260),
                _ => return None,
            };
        Some(Self { decisions, mean, off: 1 })
    }

    /// The bounds of two pictures of which neither is exact: each may be on the other side.
    pub fn both(self) -> Self {
        Self { off: 2, ..self }
    }

    /// Number of pixels of such a picture that may flip.
    pub fn flips(&self, picture: &Picture) -> u32 {
        self.flips_of(picture.width, picture.pixels.len())
    }

    fn flips_of(&self, width: u32, pixels: usize) -> u32 {
        let beside = 2.0 * f64::from(self.off) * 7.3e-7 * f64::from(width);
        self.decisions * (beside * pixels as f64).ceil() as u32
    }

    /// Tests whether two pictures of colours are as near as that. FLIP sees a picture as an eye does, blurred: one
    /// pixel that is another makes up to five that seem so.
    pub fn holds(&self, one: &Picture, other: &Picture) -> bool {
        let (mean, outliers) = pictures(one, other);
        let flipped = outliers * one.pixels.len() as f32 / 5.0;
        mean <= self.off as f32 * self.mean && flipped <= self.flips(one) as f32
    }

    /// Tests whether two pictures of answers are: instances, triangles, distances, directions.
    ///
    /// A distance changes with the direction by the tangent of the angle between ray and normal. Beyond a
    /// thousandth it does so only under a grazing angle of a thousandth, which counts as flipped.
    pub fn answers(&self, one: &Picture, other: &Picture) -> bool {
        flipped(one, other) <= self.flips(one) as usize
    }
}

/// Bound on the mean FLIP between a chapter's picture, by a device that rounds as it likes, and the golden one:
/// `own` is the bound for the software driver, which made it. `None` if a picture shows the device's own errors.
pub fn golden(chapter: &str, (width, height): (u32, u32), own: f32) -> Option<f32> {
    // What a picture of another seed has, and a hundredth of it for each surface that a path meets: see
    // `tests/samples/worst.rs`.
    let of_paths = |anew: f32, surfaces: f32| Some(own + 0.01 * surfaces * anew);
    match &chapter[..2] {
        "24" => None,
        // Of 160x100 pixels and the golden's samples, by llvmpipe (Mesa 25.0.7).
        "11" => of_paths(0.074, 5.0),
        "29" => of_paths(0.134, 5.0),
        "27" => of_paths(0.140, 20.0),
        _ => {
            let pixels = width as usize * height as usize;
            let more =
                |near: Near| near.mean + 5.0 * near.flips_of(width, pixels) as f32 / pixels as f32;
            Some(own + Near::if_any(chapter).map_or(0.0, more))
        }
    }
}

/// In how many pixels two pictures of answers are apart by more than arithmetic.
pub fn flipped(one: &Picture, other: &Picture) -> usize {
    assert_eq!((one.width, one.height), (other.width, other.height));
    let near = |(a, b): (&f32, &f32)| a == b || (a - b).abs() <= 1e-3 * a.abs().max(1.0);
    let pairs = one.pixels.iter().zip(&other.pixels);
    pairs.filter(|(one, other)| !one.iter().zip(other.iter()).all(near)).count()
}

/// Difference of one picture from another, by FLIP: the mean, and the share of pixels above 0.1.
pub fn pictures(reference: &Picture, picture: &Picture) -> (f32, f32) {
    let size = (picture.width, picture.height);
    assert_eq!((reference.width, reference.height), size);
    let (expected, actual) = (reference.srgb(), picture.srgb());
    (crate::mean(size, &expected, &actual), crate::share_above(0.1, size, &expected, &actual))
}
