//! Ray against a surface of heights: marched so that nothing is missed, then bisected, in f64.

use glam::DVec3;

use super::ray::Ray;
use super::surface::Surface;

/// `y = k·(a·S(fx·x)·S(fz·z + 1/4) + b·S(gx·x + gz·z))`, `S(u) = 8v·(1 - 2|v|)`, `v = u - round(u)`.
///
/// S looks like a sine but is two parabolas, which every device computes alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heightfield {
    /// Scales everything; 0 is flat ground.
    pub k: f64,
    /// Height of the hills.
    pub a: f64,
    /// Number of hills per unit of x.
    pub fx: f64,
    /// Number of hills per unit of z.
    pub fz: f64,
    /// Height of the ridges.
    pub b: f64,
    /// Number of ridges per unit of x.
    pub gx: f64,
    /// Number of ridges per unit of z.
    pub gz: f64,
    /// A bound for the length of the gradient.
    pub lipschitz: f64,
}

/// S and its derivative.
fn wave(u: f64) -> (f64, f64) {
    let v = u - u.round_ties_even();
    (8.0 * v * (1.0 - 2.0 * v.abs()), 8.0 * (1.0 - 4.0 * v.abs()))
}

impl Heightfield {
    /// The height at (x, z), and its derivatives along x and z.
    pub fn height(&self, x: f64, z: f64) -> (f64, [f64; 2]) {
        let Self { k, a, fx, fz, b, gx, gz, .. } = *self;
        let ((p, dp), (q, dq)) = (wave(fx * x), wave(fz * z + 0.25));
        let (r, dr) = wave(gx * x + gz * z);
        (
            k * (a * p * q + b * r),
            [k * (a * dp * fx * q + b * dr * gx), k * (a * p * dq * fz + b * dr * gz)],
        )
    }

    /// The first hit from above or below, with the upward normal.
    ///
    /// A step of `h / (L·|d_xz| + |d_y|)` cannot reach the surface (Hart, *Sphere Tracing*, The Visual
    /// Computer 12, 1996). Near it the steps would become endless: there they are `1e-7` of the way, and
    /// a pair of crossings closer together than that is missed.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let d = ray.direction;
        let above = |t: f64| {
            let p = ray.at(t);
            p.y - self.height(p.x, p.z).0
        };
        let speed = self.lipschitz * d.x.hypot(d.z) + d.y.abs();
        let highest = self.k.abs() * (self.a.abs() + self.b.abs());
        let (mut t, mut h) = (ray.tmin, above(ray.tmin));
        let sign = h.signum();
        while t < ray.tmax {
            if ray.at(t).y.abs() > highest && ray.at(t).y * d.y >= 0.0 {
                return None;
            }
            let next = (t + (h.abs() / speed).max(1e-7 * t.max(1e-3))).min(ray.tmax);
            let there = above(next);
            if there * sign <= 0.0 && next > ray.tmin {
                let (mut low, mut high) = (t, next);
                for _ in 0..80 {
                    let middle = 0.5 * (low + high);
                    if above(middle) * sign > 0.0 { low = middle } else { high = middle }
                }
                let (_, [dx, dz]) = self.height(ray.at(high).x, ray.at(high).z);
                return Some(Surface { t: high, normal: DVec3::new(-dx, 1.0, -dz).normalize() });
            }
            (t, h) = (next, there);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hills(k: f64) -> Heightfield {
        Heightfield { k, a: 0.6, fx: 0.11, fz: 0.08, b: 0.25, gx: 0.3, gz: 0.2, lipschitz: 1.5 * k }
    }

    #[test]
    fn the_derivatives_are_those_of_the_height() {
        let field = hills(1.0);
        for i in 0..100 {
            let (x, z) = (f64::from(i) * 0.37, f64::from(i) * -0.21 + 3.0);
            let (_, [dx, dz]) = field.height(x, z);
            let step = 1e-6;
            let along = |x1: f64, z1: f64| {
                (field.height(x + x1, z + z1).0 - field.height(x - x1, z - z1).0) / (2.0 * step)
            };
            assert!((along(step, 0.0) - dx).abs() < 1e-5 && (along(0.0, step) - dz).abs() < 1e-5);
            assert!(dx.hypot(dz) <= field.lipschitz);
        }
    }

    #[test]
    fn flat_ground_is_a_plane() {
        let ray = Ray::from_f32([0.0, 1.0, 0.0], [1.0, -0.125, 0.0], 0.0, 100.0);
        assert!((hills(0.0).intersect(&ray).unwrap().t - 8.0).abs() < 1e-12);
        let up = Ray::from_f32([0.0, 1.0, 0.0], [1.0, 0.125, 0.0], 0.0, 100.0);
        assert!(hills(1.0).intersect(&up).is_none());
    }
}
