//! The lens: what may be set of it, and what shaders get.

use common::Controls;
use common::scene::Camera;

/// A thin lens with an aperture before it, at the camera's eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLens {
    /// The diameter of the aperture, in the world's units; 0 is a pinhole.
    pub diameter: f32,
    /// From the eye to the plane in focus, along the view; may be infinite.
    pub focus: f32,
    /// Number of straight blades that bound the aperture; with less than 3 it is a disk.
    pub blades: u32,
    /// Rotation of the blades, in degrees.
    pub rotation: f32,
}

common::shader_struct! {
    /// A lens as shaders get it.
    pub struct Lens {
        /// Of the aperture.
        pub radius: f32,
        /// 1 over the distance of the plane in focus; 0 at infinity.
        pub inverse_focus: f32,
        /// With less than 3 the aperture is a disk.
        pub blades: u32,
        /// Of the blades, as a part of a whole turn.
        pub turn: f32,
    }
}

/// The most that a lens measures.
const WIDEST: f32 = 100.0;

impl ThinLens {
    /// Focused on what the camera looks at, and a tenth of that distance wide; six blades.
    pub fn focused_on_target(camera: &Camera) -> Self {
        let focus = camera.eye.distance(camera.target) as f32;
        Self { diameter: (focus / 10.0).min(WIDEST), focus, blades: 6, rotation: 0.0 }
    }

    /// Declares what may be set.
    pub fn controls(&mut self, c: &mut Controls) {
        c.slider("lens diameter", &mut self.diameter, 0.0..=WIDEST);
        c.slider("focus distance", &mut self.focus, 0.001..=f32::INFINITY);
        c.integer("blades", &mut self.blades, 0..=12);
        c.slider("blade rotation", &mut self.rotation, 0.0..=360.0);
    }

    /// The lens for a shader.
    pub fn shader(&self) -> Lens {
        Lens {
            radius: self.diameter / 2.0,
            inverse_focus: 1.0 / self.focus,
            blades: self.blades,
            turn: self.rotation / 360.0,
        }
    }
}
