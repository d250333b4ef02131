//! Rays, made from the bits that a GPU wrote.

use glam::{DVec3, Vec3};

/// A ray `origin + t·direction` with `tmin < t <= tmax`, in world space.
///
/// Every f32 is an f64, so a ray made from the bits that the GPU wrote is the very ray it traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point at t = 0.
    pub origin: DVec3,
    /// The vector multiplied by t; any length but 0.
    pub direction: DVec3,
    /// Lower end of the interval, itself excluded.
    pub tmin: f64,
    /// Upper end of the interval, itself included; may be infinite.
    pub tmax: f64,
}

impl Ray {
    /// The ray that these f32 bits denote, without rounding.
    pub fn from_f32(origin: [f32; 3], direction: [f32; 3], tmin: f32, tmax: f32) -> Self {
        Self {
            origin: Vec3::from(origin).as_dvec3(),
            direction: Vec3::from(direction).as_dvec3(),
            tmin: tmin.into(),
            tmax: tmax.into(),
        }
    }

    /// The point at parameter `t`, rounded to f64.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// True if `tmin < t <= tmax`; false for NaN.
    pub fn contains(&self, t: f64) -> bool {
        self.tmin < t && t <= self.tmax
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_keeps_the_bits_and_its_open_and_closed_ends() {
        let ray = Ray::from_f32([0.1, -0.0, 3e-45], [1e38, 0.3, -7.0], 0.5, 2.0);
        assert_eq!(ray.origin.x as f32, 0.1);
        assert_eq!(ray.origin.z as f32, 3e-45);
        assert_eq!(ray.direction.y, f64::from(0.3f32));
        assert!(!ray.contains(0.5) && ray.contains(0.5 + 1e-16 * 4.0));
        assert!(ray.contains(2.0) && !ray.contains(2.0 + 1e-15) && !ray.contains(f64::NAN));
    }
}
