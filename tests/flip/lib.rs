//! How different two pictures look: FLIP (Andersson et al., HPG 2020), as tests and `chapters survey` use it.

/// The largest mean FLIP error between a chapter's picture and its golden. Set by llvmpipe (Mesa 25.0.7),
/// which made the goldens.
pub const TOLERANCE: f32 = 0.002;

/// The mean FLIP error of two pictures of one size, 8 bits sRGB a channel, row by row: 0 for the same, 1 for
/// black and white.
pub fn mean((width, height): (u32, u32), expected: &[u8], actual: &[u8]) -> f32 {
    let [expected, actual] =
        [expected, actual].map(|pixels| nv_flip::FlipImageRgb8::with_data(width, height, pixels));
    let error = nv_flip::flip(expected, actual, nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    nv_flip::FlipPool::from_image(&error).mean()
}
