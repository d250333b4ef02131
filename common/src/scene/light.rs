//! Lights: what they are on the host and what shaders get.

use glam::Vec3;

/// A light so far away that its rays are parallel, placed by two angles as one places the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Degrees around the vertical; 0 is +z, 90 is +x.
    pub azimuth: f32,
    /// Degrees above the horizon.
    pub elevation: f32,
    /// Linear RGB radiance.
    pub radiance: Vec3,
}

common::shader_struct! {
    /// A directional light as shaders get it.
    pub struct DirectionalLight {
        /// Unit vector towards the light.
        pub direction: Vec3,
        /// Linear RGB radiance.
        pub radiance: Vec3,
    }
}

impl Sun {
    /// The light for a shader.
    pub fn light(&self) -> DirectionalLight {
        let (azimuth, elevation) = (self.azimuth.to_radians(), self.elevation.to_radians());
        let horizontal = elevation.cos();
        DirectionalLight {
            direction: Vec3::new(
                azimuth.sin() * horizontal,
                elevation.sin(),
                azimuth.cos() * horizontal,
            ),
            radiance: self.radiance,
        }
    }
}

impl Default for Sun {
    fn default() -> Self {
        Self { azimuth: 300.0, elevation: 42.0, radiance: Vec3::new(2.6, 2.4, 2.1) }
    }
}
