//! Lights: what they are on the host and what shaders get.

use glam::Vec3;

use crate::gpu::Number;

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

/// A light that shines from one place equally in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Where it is, in the world.
    pub position: Vec3,
    /// Linear RGB intensity: what arrives at distance 1, a quarter of it at distance 2.
    pub intensity: Vec3,
}

common::shader_enum! {
    /// What kind of light it is (`shaders/common/light.glsl`).
    pub enum LightKind: LIGHT {
        /// So far away that its rays are parallel.
        Directional,
        /// At a place.
        Point,
    }
    /// How a shadow ray is traced (`push.glsl` of 05_shadow_miss and of those that follow it).
    pub enum ShadowRays: SHADOW {
        /// It ends at the first hit that it finds.
        FirstHit,
        /// It finds the nearest hit.
        NearestHit,
        /// There are none.
        Off,
    }
}

common::shader_struct! {
    /// A light of either kind, with a size, as shaders get it (`shaders/common/light.glsl`).
    pub struct Light {
        /// Directional: unit vector towards the light. Point: its position.
        pub place: Vec3,
        /// Directional or point.
        pub kind: Number<LightKind>,
        /// Linear RGB. Directional: radiance. Point: intensity.
        pub strength: Vec3,
        /// Radius of the disk that shines, around `place`; 0 casts hard shadows.
        pub size: f32,
        /// Shadow rays a hit, where it has a size.
        pub samples: u32,
    }
}

impl Light {
    /// The sun as a disk: `size` is its radius as seen from distance 1, the true sun's 0.0047.
    pub fn directional(sun: &Sun, size: f32) -> Self {
        let DirectionalLight { direction, radiance } = sun.light();
        Self {
            place: direction,
            kind: LightKind::Directional.into(),
            strength: radiance,
            size,
            samples: 1,
        }
    }

    /// A lamp as a disk that faces whoever looks at it; `size` is its radius in the world.
    pub fn point(lamp: &PointLight, size: f32) -> Self {
        Self {
            place: lamp.position,
            kind: LightKind::Point.into(),
            strength: lamp.intensity,
            size,
            samples: 1,
        }
    }
}

impl Default for PointLight {
    fn default() -> Self {
        Self { position: Vec3::new(-1.5, 3.2, 0.5), intensity: Vec3::new(36.0, 29.0, 20.0) }
    }
}

impl Default for Sun {
    fn default() -> Self {
        Self { azimuth: 300.0, elevation: 42.0, radiance: Vec3::new(2.6, 2.4, 2.1) }
    }
}
