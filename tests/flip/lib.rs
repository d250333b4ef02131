//! The perceived difference of two pictures: FLIP (Andersson et al., HPG 2020), as used by tests and `cargo
//! chapters`.

pub mod near;

/// The largest mean FLIP error between a chapter's picture and its golden. Set by llvmpipe (Mesa 25.0.7),
/// which made the goldens.
pub const TOLERANCE: f32 = 0.002;

/// The mean FLIP error of two pictures of the same size, 8 bits of sRGB per channel, row by row: 0 if equal,
/// 1 for black and white.
pub fn mean(size: (u32, u32), expected: &[u8], actual: &[u8]) -> f32 {
    nv_flip::FlipPool::from_image(&errors(size, expected, actual)).mean()
}

/// The share of pixels whose FLIP error is above `bound`, from 0 to 1.
pub fn share_above(bound: f32, size: (u32, u32), expected: &[u8], actual: &[u8]) -> f32 {
    let errors = errors(size, expected, actual).to_vec();
    errors.iter().filter(|error| **error > bound).count() as f32 / errors.len() as f32
}

fn errors((width, height): (u32, u32), expected: &[u8], actual: &[u8]) -> nv_flip::FlipImageFloat {
    let [expected, actual] =
        [expected, actual].map(|pixels| nv_flip::FlipImageRgb8::with_data(width, height, pixels));
    nv_flip::flip(expected, actual, nv_flip::DEFAULT_PIXELS_PER_DEGREE)
}
