//! Ray against a voxel of a distance grid: a polynomial of degree three, and its roots exactly.

use dashu::rational::RBig;
use glam::DVec3;

use super::clipped::{End, roots_within, span};
use super::rational::rational;
use super::ray::Ray;
use super::surface::Surface;

/// A box with a number at each corner, and in it their trilinear mean; the surface is where that is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Voxel {
    /// The low corner; its three faces belong to the voxel.
    pub low: DVec3,
    /// The high corner, above the low one in every axis; its three faces belong to the next voxels.
    pub high: DVec3,
    /// The numbers, with x changing fastest and z slowest.
    pub corners: [f64; 8],
}

impl Voxel {
    /// The t of all hits within the ray's interval, in order, to f64. A touch counts once; a ray along which the mean is 0
    /// everywhere has none.
    ///
    /// # Panics
    /// If a number is not finite (but `tmax`).
    pub fn hits(&self, ray: &Ray) -> Vec<f64> {
        let Some(span) = self.span(ray) else { return Vec::new() };
        roots_within(&self.along(ray), &span, ray)
    }

    /// The first hit, with the normal in f64, to where the mean grows.
    ///
    /// # Panics
    /// If a number is not finite (but `tmax`).
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let t = *self.hits(ray).first()?;
        Some(Surface { t, normal: self.gradient(ray.at(t)).normalize_or_zero() })
    }

    /// The direction in which the mean grows, and how fast.
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        let size = self.high - self.low;
        let at = (point - self.low) / size;
        let weight = |k: usize, is_high: bool| if is_high { at[k] } else { 1.0 - at[k] };
        let mut gradient = DVec3::ZERO;
        for (n, corner) in self.corners.iter().enumerate() {
            let is_high = [n & 1 != 0, n & 2 != 0, n & 4 != 0];
            for k in 0..3 {
                let [i, j] = [(k + 1) % 3, (k + 2) % 3];
                let side = if is_high[k] { 1.0 } else { -1.0 };
                gradient[k] += side * corner * weight(i, is_high[i]) * weight(j, is_high[j]);
            }
        }
        gradient / size
    }

    /// The mean along the ray, by the powers of t, times the box's volume.
    fn along(&self, ray: &Ray) -> [RBig; 4] {
        let mut sum = [RBig::ZERO, RBig::ZERO, RBig::ZERO, RBig::ZERO];
        for (n, corner) in self.corners.iter().enumerate() {
            let mut product = vec![rational(*corner)];
            for k in 0..3 {
                let (o, d) = (rational(ray.origin[k]), rational(ray.direction[k]));
                let [from, slope] = if n >> k & 1 != 0 {
                    [o - rational(self.low[k]), d]
                } else {
                    [rational(self.high[k]) - o, -d]
                };
                product.push(RBig::ZERO);
                for power in (0..product.len()).rev() {
                    let lower = power.checked_sub(1).map(|i| &product[i] * &slope);
                    product[power] = &product[power] * &from + lower.unwrap_or_default();
                }
            }
            for (to, x) in sum.iter_mut().zip(product) {
                *to += x;
            }
        }
        sum
    }

    /// The ray's way through the box.
    fn span(&self, ray: &Ray) -> Option<[End; 2]> {
        let goes_along_high_face =
            (0..3).any(|k| ray.direction[k] == 0.0 && ray.origin[k] == self.high[k]);
        let mut ends = span(self.low, self.high, ray).filter(|_| !goes_along_high_face)?;
        for end in &mut ends {
            end.is_inside = end.are_low;
        }
        Some(ends)
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::super::rational::to_f64;
    use super::*;

    fn unit(corners: [f64; 8]) -> Voxel {
        Voxel { low: DVec3::ZERO, high: DVec3::ONE, corners }
    }

    fn hits(voxel: &Voxel, origin: [f64; 3], direction: [f64; 3]) -> Vec<f64> {
        let [origin, direction] = [origin, direction].map(DVec3::from);
        voxel.hits(&Ray { origin, direction, tmin: 0.0, tmax: 1e30 })
    }

    /// z - 1/4.
    const FLOOR: [f64; 8] = [-0.25, -0.25, -0.25, -0.25, 0.75, 0.75, 0.75, 0.75];

    #[test]
    fn known_rays_have_their_known_hits() {
        let floor = unit(FLOOR);
        assert_eq!(hits(&floor, [0.5, 0.5, 4.0], [0.0, 0.0, -1.0]), [3.75]);
        assert!(hits(&floor, [1.5, 0.5, 4.0], [0.0, 0.0, -1.0]).is_empty());
        assert!(hits(&floor, [-1.0, 0.5, 0.25], [1.0, 0.0, 0.0]).is_empty(), "in the surface");
        // (x - 1/2)(y - 1/2): along the diagonal a square, across it a difference of squares.
        let saddle = unit([0.25, -0.25, -0.25, 0.25, 0.25, -0.25, -0.25, 0.25]);
        assert_eq!(hits(&saddle, [-1.0, -1.0, 0.5], [1.0, 1.0, 0.0]), [1.5]);
        assert_eq!(hits(&saddle, [-1.0, -0.75, 0.5], [1.0, 1.0, 0.0]), [1.25, 1.5]);
        // xyz - 1/8 along the diagonal of space: the cube of a root.
        let corner = unit([-0.125, -0.125, -0.125, -0.125, -0.125, -0.125, -0.125, 0.875]);
        assert_eq!(hits(&corner, [-1.0; 3], [1.0; 3]), [1.5]);
    }

    #[test]
    fn a_face_between_two_voxels_counts_once() {
        // x - 1, in the voxel below it and in the one above.
        let below = unit([-1.0, 0.0, -1.0, 0.0, -1.0, 0.0, -1.0, 0.0]);
        let (low, high) = (DVec3::X, DVec3::new(2.0, 1.0, 1.0));
        let above = Voxel { low, high, corners: [0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0] };
        for direction in [1.0, -1.0] {
            let ray = ([1.0 - 2.0 * direction, 0.5, 0.5], [direction, 0.0, 0.0]);
            assert!(hits(&below, ray.0, ray.1).is_empty());
            assert_eq!(hits(&above, ray.0, ray.1), [2.0]);
        }
        // Slanted, through an edge of both.
        assert!(hits(&below, [0.0, -1.0, 0.5], [1.0, 1.0, 0.0]).is_empty());
        assert_eq!(hits(&above, [0.0, -1.0, 0.5], [1.0, 1.0, 0.0]), [1.0]);
    }

    #[test]
    fn hits_are_zeros_and_signs_change_at_an_odd_number() {
        let mut random = Random(65);
        let mut met = [0; 4];
        for _ in 0..600 {
            let corners = std::array::from_fn(|_| f64::from(random.between(-1.0, 1.0) as f32));
            let low = f32s(random.in_cube());
            let voxel = Voxel { low, high: f32s(low + DVec3::splat(0.75)), corners };
            let ray = towards(f32s(random.unit() * 4.0), low + random.in_cube() * 0.2 + 0.375);
            let found = voxel.hits(&ray);
            assert!(found.is_sorted());
            met[found.len()] += 1;
            let size = voxel.high - voxel.low;
            let mean = |p: DVec3| {
                let at = (p - voxel.low) / size;
                let weight = |n: usize, k: usize| if n >> k & 1 != 0 { at[k] } else { 1.0 - at[k] };
                let all = corners.iter().enumerate();
                all.map(|(n, c)| c * weight(n, 0) * weight(n, 1) * weight(n, 2)).sum::<f64>()
            };
            for t in &found {
                assert!(mean(ray.at(*t)).abs() < 1e-13, "{voxel:?} {ray:?}");
            }
            let [enter, leave] =
                voxel.span(&ray).expect("it aims at the box").map(|e| to_f64(&e.t));
            let changes = (mean(ray.at(enter)) > 0.0) != (mean(ray.at(leave)) > 0.0);
            assert_eq!(changes, found.len() % 2 == 1, "{voxel:?} {ray:?}");
        }
        assert!(met[0] > 50 && met[1] > 50 && met[2] > 5, "{met:?}");
    }
}
