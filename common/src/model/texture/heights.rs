//! Heights in grey, as `map_Bump` names them, turned into the slopes of normals.

/// The largest difference of two channels of a grey texel: JPEG does not keep grey exactly.
const COLORFUL: u8 = 24;

/// The stored x and y of a slope of 1.
///
/// One grey level between two neighbours is a slope of 1/510. Times 16, shaders can tell it from the zero of a normal
/// map, which has no byte of its own, and a half float holds it with ten bits beside the 1/2 that a texel of 0 means.
pub(crate) const SLOPES_PER_UNIT: f32 = 16.0;

/// True if no texel has a colour.
pub(crate) fn is_grey(rgba: &[u8]) -> bool {
    let is_grey = |texel: &[u8]| {
        let [low, high] = [texel[..3].iter().min(), texel[..3].iter().max()];
        low.zip(high).is_some_and(|(low, high)| high - low <= COLORFUL)
    };
    rgba.chunks_exact(4).all(is_grey)
}

/// Replaces the heights of a grey image by x and y of normals whose z is 1, as half floats: from 0 to 1 for -1 to 1
/// as in a normal map, but not limited to that, and [`SLOPES_PER_UNIT`] times as steep.
///
/// Black is 0 and white 1 texel high. A texel's slope is half the difference of its two neighbours. The image
/// continues beyond its edges as a texture does, by repetition.
pub(super) fn to_slopes(rgba: &mut [u8], width: usize) {
    let heights: Vec<u8> = rgba.chunks_exact(4).map(|texel| texel[1]).collect();
    let height = heights.len() / width.max(1);
    let at = |x: usize, y: usize| f32::from(heights[y % height * width + x % width]) / 255.0;
    for (i, texel) in rgba.chunks_exact_mut(4).enumerate() {
        let (x, y) = (i % width, i / width);
        let right = 0.5 * (at(x + 1, y) - at(x + width - 1, y));
        // The rows of an image begin at the top.
        let up = 0.5 * (at(x, y + height - 1) - at(x, y + 1));
        let written = |slope: f32| half(0.5 - 0.5 * SLOPES_PER_UNIT * slope).to_le_bytes();
        texel[..2].copy_from_slice(&written(right));
        texel[2..].copy_from_slice(&written(up));
    }
}

/// The half float nearest to a number, whose size is below 65504; 0 for sizes below 2^-14.
fn half(x: f32) -> u16 {
    let bits = x.to_bits();
    let size = bits & 0x7fff_ffff;
    if size < 0x3880_0000 {
        return 0;
    }
    // The exponent counts from 15 instead of 127, and 13 bits are rounded off, to even in the middle.
    let rounded = (size + 0xfff + (size >> 13 & 1)) - 0x3800_0000;
    (bits >> 16 & 0x8000 | rounded >> 13) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(grey: &[u8]) -> Vec<u8> {
        grey.iter().flat_map(|&g| [g, g, g, 255]).collect()
    }

    /// Twice the value of a half float, less 1: what shaders make of it.
    fn read(bytes: &[u8]) -> f32 {
        let bits = u32::from(u16::from_le_bytes([bytes[0], bytes[1]]));
        let size = f32::from_bits(((bits & 0x7fff) << 13) + 0x3800_0000);
        2.0 * if bits & 0x8000 == 0 { size } else { -size } - 1.0
    }

    #[test]
    fn half_floats_are_rounded_to_the_nearest() {
        for (x, bits) in [
            (1.0, 0x3c00),
            (-2.0, 0xc000),
            (0.5, 0x3800),
            (65504.0, 0x7bff),
            (1.0 + 1.0 / 2048.0, 0x3c00),
            (1.0 + 3.0 / 2048.0, 0x3c02),
            (1.0 + 1.1 / 2048.0, 0x3c01),
            (2f32.powi(-14), 0x0400),
            (1e-6, 0),
        ] {
            assert_eq!(half(x), bits, "{x}");
        }
    }

    #[test]
    fn a_rise_to_the_right_and_up_turns_the_normal_to_the_left_and_down() {
        // Rows from the top: the middle texel rises by 40 to the right, and by 60 upwards.
        let mut rgba = image(&[0, 160, 0, 80, 100, 120, 0, 100, 0]);
        to_slopes(&mut rgba, 3);
        for (bytes, step) in [(&rgba[16..18], 40.0), (&rgba[18..20], 60.0)] {
            let slope = read(bytes) / SLOPES_PER_UNIT;
            assert!((slope + step / 2.0 / 255.0).abs() < 1e-3 * step / 255.0, "{slope} for {step}");
        }
    }

    #[test]
    fn one_grey_level_per_texel_is_a_slope() {
        let mut rgba = image(&[7, 8, 9, 10]);
        to_slopes(&mut rgba, 4);
        for texel in [&rgba[4..], &rgba[8..]] {
            assert!((read(texel) / SLOPES_PER_UNIT + 1.0 / 255.0).abs() < 1e-4);
            // Shaders take less for the zero of a normal map.
            assert!(read(texel).abs() > 0.004);
        }
    }

    #[test]
    fn a_flat_image_is_flat_across_its_edges() {
        let mut rgba = image(&[77; 6]);
        to_slopes(&mut rgba, 2);
        assert!(rgba.chunks_exact(2).all(|part| read(part) == 0.0));
        let mut single = image(&[9]);
        to_slopes(&mut single, 1);
        assert!(single.chunks_exact(2).all(|part| read(part) == 0.0));
    }

    #[test]
    fn grey_is_told_from_colours() {
        assert!(is_grey(&image(&[0, 255, 9])) && is_grey(&[100, 110, 120, 0]));
        assert!(!is_grey(&[128, 128, 255, 255, 10, 10, 10, 255]));
    }
}
