//! A texture's alpha: what a lookup gives, and what lookups can give over a part of it.

use glam::DVec2;

/// Alpha from here on counts as opaque.
pub const THRESHOLD: f64 = 0.5;

/// Least distance of a texel from the threshold. A device's filter has few bits, and two devices may differ where
/// alpha is this near.
pub const GUARD: f64 = 0.02;

/// The error of a device's filter in its place, in texels: a device resolves a place to at least four binary digits
/// of a texel (`subTexelPrecisionBits`).
pub const SUBTEXEL: f64 = 1.0 / 16.0;

/// The alpha channel of a texture, repeated beyond its edges.
pub struct Alpha {
    size: [usize; 2],
    alpha: Vec<u8>,
    /// Numbers of texels above and left of a corner that are surely opaque, and surely transparent.
    sums: Vec<[u32; 2]>,
}

impl Alpha {
    /// Takes the alpha of texels of four bytes, row by row.
    pub fn new(width: u32, height: u32, rgba: &[u8]) -> Self {
        let size @ [width, height] = [width as usize, height as usize];
        let alpha: Vec<u8> = rgba.iter().skip(3).step_by(4).copied().collect();
        let mut sums = vec![[0; 2]; (width + 1) * (height + 1)];
        for y in 0..height {
            let mut row = [0; 2];
            for x in 0..width {
                let texel = f64::from(alpha[y * width + x]) / 255.0;
                row[0] += u32::from(texel >= THRESHOLD + GUARD);
                row[1] += u32::from(texel <= THRESHOLD - GUARD);
                let above = sums[y * (width + 1) + x + 1];
                sums[(y + 1) * (width + 1) + x + 1] = [above[0] + row[0], above[1] + row[1]];
            }
        }
        Self { size, alpha, sums }
    }

    /// Texels in a row, and rows.
    pub fn size(&self) -> DVec2 {
        DVec2::new(self.size[0] as f64, self.size[1] as f64)
    }

    /// The common result of every lookup between two corners of a box, in texture coordinates: opaque, transparent,
    /// or nothing certain. A lookup lies between the least and the largest of the texels that it reads, whatever
    /// their shares.
    pub fn certain(&self, low: DVec2, high: DVec2) -> Option<bool> {
        let (columns, rows) =
            (texels(low.x, high.x, self.size[0])?, texels(low.y, high.y, self.size[1])?);
        let mut found = [0; 3];
        for &(left, right) in &columns {
            for &(top, bottom) in &rows {
                found[0] += ((right - left) * (bottom - top)) as u32;
                let [opaque, transparent] = self.count([left, right], [top, bottom]);
                found[1] += opaque;
                found[2] += transparent;
            }
        }
        let [all, opaque, transparent] = found;
        if opaque == all { Some(true) } else { (transparent == all).then_some(false) }
    }

    /// Numbers of texels in a rectangle that are surely opaque, and surely transparent.
    fn count(&self, [left, right]: [usize; 2], [top, bottom]: [usize; 2]) -> [u32; 2] {
        let at = |x: usize, y: usize| self.sums[y * (self.size[0] + 1) + x];
        let (a, b, c, d) = (at(right, bottom), at(left, bottom), at(right, top), at(left, top));
        [a[0] + d[0] - b[0] - c[0], a[1] + d[1] - b[1] - c[1]]
    }

    /// A lookup: the four texels around a place by their shares.
    pub fn lookup(&self, uv: DVec2) -> f64 {
        let place = uv * self.size() - 0.5;
        let (first, share) = (place.floor(), place - place.floor());
        let both = |first: f64, size: usize| {
            [first, first + 1.0].map(|place| place.rem_euclid(size as f64) as usize)
        };
        let ([left, right], [above, below]) =
            (both(first.x, self.size[0]), both(first.y, self.size[1]));
        let texel = |x: usize, y: usize| f64::from(self.alpha[y * self.size[0] + x]) / 255.0;
        let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
        let upper = mix(texel(left, above), texel(right, above), share.x);
        mix(upper, mix(texel(left, below), texel(right, below), share.x), share.y)
    }
}

/// The columns, or rows, that lookups between two coordinates can read, as ranges within the texture: the second is
/// empty unless they go over its edge. None if a coordinate is not finite.
fn texels(low: f64, high: f64, size: usize) -> Option<[(usize, usize); 2]> {
    let length = size as f64;
    // A lookup reads the two texels whose middles are on either side of it.
    let first = (low * length - 0.5 - SUBTEXEL).floor();
    let behind = (high * length - 0.5 + SUBTEXEL).floor() + 2.0;
    if !(behind - first).is_finite() {
        return None;
    }
    if behind - first >= length {
        return Some([(0, size), (0, 0)]);
    }
    let start = first.rem_euclid(length) as usize;
    let end = start + (behind - first) as usize;
    Some([(start, end.min(size)), (0, end.saturating_sub(size))])
}
