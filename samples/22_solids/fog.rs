//! Fog of one density, which fills the world except for the solids.

use common::Controls;
use glam::Vec3;

common::shader_enum! {
    /// The place of the fog: nowhere, in the solids also, or only outside of them.
    pub enum Extent: FOG { None, Everywhere, Outside }
}

common::shader_struct! {
    /// Fog, as shaders get it.
    pub struct Fog {
        /// Colour of the fog seen from within, linear RGB.
        pub color: Vec3,
        /// The distance after which 1/e of the light is left; 0 without fog.
        pub distance: f32,
    }
}

impl Default for Fog {
    /// A clear day.
    fn default() -> Self {
        Self { color: Vec3::new(0.62, 0.66, 0.72), distance: 0.0 }
    }
}

impl Fog {
    /// The controls.
    pub fn controls(&mut self, c: &mut Controls) {
        c.slider("fog distance", &mut self.distance, 0.0..=1e4);
        c.color("fog color", &mut self.color);
    }

    /// The fog where a scene is so many times as large.
    pub fn placed(&self, size: f64) -> Self {
        Self { distance: (f64::from(self.distance) * size) as f32, ..*self }
    }

    /// The place of the fog; hollow solids let it in. A camera enclosed by a closed solid sees
    /// none: no path ever leaves.
    pub fn extent(&self, hollow: bool, enclosed: bool) -> Extent {
        match (self.distance > 0.0, hollow, enclosed) {
            (false, ..) | (true, false, true) => Extent::None,
            (true, true, _) => Extent::Everywhere,
            (true, false, false) => Extent::Outside,
        }
    }
}
