//! Bounds on the difference of two pictures from different pipelines, on a device with rounding of its own.

use common::app::Picture;

/// Bounds on the difference of a picture from exact arithmetic: the number of decisions per pixel, each of
/// which may *flip*, and the mean FLIP.
///
/// A ray's direction is off by about 4 ULP of 1, which is 7e-5 of a pixel in a picture 96 pixels wide. An
/// edge that passes this close to a pixel's centre, on either side, flips it: less than one of 5,760
/// pixels, even if all of them have an edge. The same holds for a second decision, if its point is as
/// accurate. Larger pictures have more pixels, and smaller ones.
///
/// A colour is off if a texture is sampled at another place: an error of 16 ULP of 1 in the weights is a
/// thousandth of a texel of 512, and a quarter of a step of 1/255 between black and white. So at most a
/// quarter of the pixels change by a step, which has a FLIP of 0.005.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    decisions: u32,
    /// The mean FLIP.
    pub mean: f32,
    /// The number of the two pictures that are inexact.
    off: u32,
}

impl Near {
    /// The bounds for a chapter's pictures, compared with a nearly exact one.
    ///
    /// # Panics
    /// If the chapter has no bounds, because its paths are random.
    pub fn of(chapter: &str) -> Self {
        Self::if_any(chapter).unwrap_or_else(|| panic!("how near is a picture of {chapter}?"))
    }

    /// As [`Near::of`]; `None` if the chapter has no bounds.
    pub fn if_any(chapter: &str) -> Option<Self> {
        let (decisions, mean) =
            match chapter[..2].parse().expect("a chapter begins with its number") {
                // Only the nearest hit decides; lines fade out within a pixel (20).
                1 | 2 | 7 | 9 | 10 | 20 | 24 => (1, 0.00125),
                // A second decision: a hole (03, 15) or a random number (03), the hit of a shadow ray (04 and
                // later), the first of two faces of a solid (22), the cell of a lattice (13). Those of rays
                // to the sky change a colour by a sixteenth of the ambient light, a few steps of 1/255 (17).
                3 | 4 | 5 | 8 | 13..=18 | 21..=23 | 30 | 34 | 36..=39 | 41 => (2, 0.00125),
                // Rays reflected by round mirrors: each time, an error grows by the distance over the radius,
                // and a colour comes from two or more surfaces. The mirrors' Fresnel factor dims most of
                // their decisions.
                6 | 12 | 26 => (2, 0.0025),
                // As before, and one more decision: Vulkan allows an error of 2^-11 in a sine, and so in the
                // direction of a bounce in 25, and in the point on the lens in 28 and on the light in 35. The
                // hit of such a ray changes a colour as much as that of a shadow ray.
                25 => (2, 0.0025 + 0.00125),
                28 | 35 => (2, 0.00125 + 0.00125),
                // Mip levels: a device makes each from the previous one and rounds it to 8 bits, up or down,
                // so a lookup may be off by a step of 1/255. Half of the pixels of 19's picture sample a
                // texture, and three quarters of 40's have another colour on an NVIDIA H200. llvmpipe's own
                // pictures (240x150), with these pixels a step brighter, have a mean FLIP of 0.0187 and
                // 0.0260.
                19 => (2, 0.00125 + 0.0187),
                40 => (2, 0.00125 + 0.0260),
                _ => return None,
            };
        Some(Self { decisions, mean, off: 1 })
    }

    /// The bounds for two inexact pictures, whose errors may have opposite signs.
    pub fn both(self) -> Self {
        Self { off: 2, ..self }
    }

    /// The number of pixels of such a picture that may flip.
    pub fn flips(&self, picture: &Picture) -> u32 {
        self.flips_of(picture.width, picture.pixels.len())
    }

    fn flips_of(&self, width: u32, pixels: usize) -> u32 {
        let beside = 2.0 * f64::from(self.off) * 7.3e-7 * f64::from(width);
        self.decisions * (beside * pixels as f64).ceil() as u32
    }

    /// Returns whether two pictures of colours are within the bounds. FLIP blurs a picture like the eye: a
    /// single different pixel shows up in as many as five.
    pub fn holds(&self, one: &Picture, other: &Picture) -> bool {
        let (mean, outliers) = pictures(one, other);
        let flipped = outliers * one.pixels.len() as f32 / 5.0;
        mean <= self.off as f32 * self.mean && flipped <= self.flips(one) as f32
    }

    /// Returns whether two pictures of data are within the bounds: instances, triangles, distances,
    /// directions.
    ///
    /// A distance changes with the direction by the tangent of the angle between ray and normal. Beyond a
    /// thousandth it does so only under a grazing angle of a thousandth, which counts as flipped.
    pub fn answers(&self, one: &Picture, other: &Picture) -> bool {
        flipped(one, other) <= self.flips(one) as usize
    }
}

/// Bound on the mean FLIP between a chapter's picture on any device and its golden picture; `own` is the
/// bound for the software driver, which made it. `None` if a picture shows the device's own errors.
pub fn golden(chapter: &str, (width, height): (u32, u32), own: f32) -> Option<f32> {
    // The difference of a picture with another seed, and a hundredth of it for each surface on a path: see
    // `tests/samples/worst.rs`.
    let of_paths = |anew: f32, surfaces: f32| Some(own + 0.01 * surfaces * anew);
    match &chapter[..2] {
        "24" => None,
        // For 160x100 pixels and the golden picture's samples, by llvmpipe (Mesa 25.0.7).
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

/// The number of pixels in which two pictures of data differ by more than rounding.
pub fn flipped(one: &Picture, other: &Picture) -> usize {
    assert_eq!((one.width, one.height), (other.width, other.height));
    let near = |(a, b): (&f32, &f32)| a == b || (a - b).abs() <= 1e-3 * a.abs().max(1.0);
    let pairs = one.pixels.iter().zip(&other.pixels);
    pairs.filter(|(one, other)| !one.iter().zip(other.iter()).all(near)).count()
}

/// The FLIP difference of two pictures: the mean, and the share of pixels above 0.1.
pub fn pictures(reference: &Picture, picture: &Picture) -> (f32, f32) {
    let size = (picture.width, picture.height);
    assert_eq!((reference.width, reference.height), size);
    let (expected, actual) = (reference.srgb(), picture.srgb());
    (crate::mean(size, &expected, &actual), crate::share_above(0.1, size, &expected, &actual))
}
