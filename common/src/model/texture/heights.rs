//! Heights in grey, as `map_Bump` names them, turned into normals.

use glam::Vec3;

/// The largest difference of two channels of a grey texel: JPEG does not keep grey exactly.
const COLORFUL: u8 = 24;

/// Replaces the heights of an image by normals, or leaves an image as it is and returns false if it is not grey.
///
/// A step from black to white between two texels is a slope of 1. The image continues beyond its edges as a texture
/// does, by repetition.
pub(super) fn to_normals(rgba: &mut [u8], width: usize) -> bool {
    let is_grey = |texel: &[u8]| {
        let [low, high] = [texel[..3].iter().min(), texel[..3].iter().max()];
        low.zip(high).is_some_and(|(low, high)| high - low <= COLORFUL)
    };
    if !rgba.chunks_exact(4).all(is_grey) {
        return false;
    }
    let heights: Vec<u8> = rgba.chunks_exact(4).map(|texel| texel[1]).collect();
    let height = heights.len() / width.max(1);
    let at = |x: usize, y: usize| f32::from(heights[y % height * width + x % width]) / 255.0;
    for (i, texel) in rgba.chunks_exact_mut(4).enumerate() {
        let (x, y) = (i % width, i / width);
        let right = 0.5 * (at(x + 1, y) - at(x + width - 1, y));
        // The rows of an image begin at the top.
        let up = 0.5 * (at(x, y + height - 1) - at(x, y + 1));
        texel[..3].copy_from_slice(&encoded(Vec3::new(-right, -up, 1.0).normalize()));
    }
    true
}

/// A unit vector in a texel: -1 is 0, and 1 is 255.
fn encoded(normal: Vec3) -> [u8; 3] {
    normal.to_array().map(|part| (127.5 + 127.5 * part).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(grey: &[u8]) -> Vec<u8> {
        grey.iter().flat_map(|&g| [g, g, g, 255]).collect()
    }

    #[test]
    fn a_rise_to_the_right_and_up_turns_the_normal_to_the_left_and_down() {
        // Rows from the top: the middle texel rises by 40 to the right, and by 60 upwards.
        let mut rgba = image(&[0, 160, 0, 80, 100, 120, 0, 100, 0]);
        assert!(to_normals(&mut rgba, 3));
        let slope = |steps: f32| steps / 2.0 / 255.0;
        let normal = Vec3::new(-slope(40.0), -slope(60.0), 1.0).normalize();
        assert_eq!(rgba[16..19], encoded(normal));
        assert!(rgba[16] < 128 && rgba[17] < 128 && rgba[19] == 255);
    }

    #[test]
    fn a_flat_image_is_flat_across_its_edges() {
        let mut rgba = image(&[77; 6]);
        assert!(to_normals(&mut rgba, 2));
        assert!(rgba.chunks_exact(4).all(|texel| texel == [128, 128, 255, 255]));
        let mut single = image(&[9]);
        assert!(to_normals(&mut single, 1));
        assert_eq!(single, [128, 128, 255, 255]);
    }

    #[test]
    fn colours_are_left_as_they_are() {
        let mut rgba = vec![128, 128, 255, 255, 10, 10, 10, 255];
        let before = rgba.clone();
        assert!(!to_normals(&mut rgba, 2));
        assert_eq!(rgba, before);
    }
}
