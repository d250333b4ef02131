//! Fog of one density, which fills the world but for the solids.

use common::Controls;
use glam::Vec3;

/// There is none.
pub const NONE: u32 = 0;
/// It is in the solids, too.
pub const EVERYWHERE: u32 = 1;
/// It fills what is outside of them.
pub const OUTSIDE: u32 = 2;

common::shader_struct! {
    /// Fog, as shaders get it.
    pub struct Fog {
        /// What is seen of it from within, linear RGB.
        pub color: Vec3,
        /// After which way 1/e of the light is left; 0 where there is no fog.
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

    // ANCHOR: extent
    /// Where it is: [`NONE`], [`EVERYWHERE`] if solids are hollow, or [`OUTSIDE`]. A camera that a
    /// closed solid encloses sees none: no path ever comes out.
    pub fn extent(&self, hollow: bool, enclosed: bool) -> u32 {
        match (self.distance > 0.0, hollow, enclosed) {
            (false, ..) | (true, false, true) => NONE,
            (true, true, _) => EVERYWHERE,
            (true, false, false) => OUTSIDE,
        }
    }
    // ANCHOR_END: extent
}
