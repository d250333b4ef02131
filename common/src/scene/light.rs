//! Lights on the host, and in their form for shaders.

use glam::Vec3;

use crate::gpu::Number;

/// A light so far away that its rays are parallel, positioned like the sun by two angles.
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
    /// A directional light in its form for shaders.
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

/// A light that shines equally in all directions from one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Its position in the world.
    pub position: Vec3,
    /// Linear RGB intensity: the irradiance at distance 1; at distance 2, a quarter of it arrives.
    pub intensity: Vec3,
}

/// A light of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// At an infinite distance, so that its rays are parallel.
    Directional {
        /// Unit vector towards the light.
        direction: Vec3,
        /// Linear RGB radiance.
        radiance: Vec3,
    },
    /// At a point.
    Point(PointLight),
}

common::shader_enum! {
    /// The kind of light (`shaders/common/light.glsl`).
    pub enum LightKind: LIGHT {
        /// At an infinite distance, so that its rays are parallel.
        Directional,
        /// At a point.
        Point,
    }
}

common::shader_struct! {
    /// A light of either kind, in its form for shaders (`shaders/common/light.glsl`).
    pub struct Light {
        /// Directional: unit vector towards the light. Point: its position.
        pub place: Vec3,
        /// Directional or point.
        pub kind: Number<LightKind>,
        /// Linear RGB. Directional: radiance. Point: intensity.
        pub strength: Vec3,
    }
}

common::shader_struct! {
    /// A disk that shines, around a light and facing the point it lights (`shaders/common/disk.glsl`).
    pub struct DiskLight {
        /// Its middle, and the strength of the whole disk.
        pub light: Light,
        /// Point: in the world. Directional: as seen from distance 1; the true sun's is 0.0047.
        pub radius: f32,
        /// Shadow rays per hit, if the radius is not 0.
        pub samples: u32,
    }
}

impl Light {
    /// The sun.
    pub fn directional(sun: &Sun) -> Self {
        let DirectionalLight { direction, radiance } = sun.light();
        Self { place: direction, kind: LightKind::Directional.into(), strength: radiance }
    }

    /// A lamp.
    pub fn point(lamp: &PointLight) -> Self {
        Self { place: lamp.position, kind: LightKind::Point.into(), strength: lamp.intensity }
    }
}

impl From<LightSource> for Light {
    fn from(source: LightSource) -> Self {
        match source {
            LightSource::Directional { direction, radiance } => {
                Self { place: direction, kind: LightKind::Directional.into(), strength: radiance }
            }
            LightSource::Point(lamp) => Self::point(&lamp),
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
