//! A chapter's light: its controls, and its form for shaders.

use super::Controls;
use crate::scene::{Light, LightKind, PointLight, Sun};

/// A sun and a lamp, one of which shines; 34_lights explains the shader code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// The sun.
    pub sun: Sun,
    /// The lamp.
    pub lamp: PointLight,
    /// The one that shines.
    pub kind: LightKind,
}

impl Lighting {
    /// A sun, and a lamp over the board that is switched off.
    pub fn new(sun: Sun) -> Self {
        Self { sun, lamp: PointLight::default(), kind: LightKind::Directional }
    }

    /// Declares the controls.
    pub fn controls(&mut self, c: &mut Controls) {
        c.choice("light", &mut self.kind);
        self.controls_of_both(c);
        c.needs("sun azimuth", "light=directional", self.kind == LightKind::Directional);
        c.needs("sun elevation", "light=directional", self.kind == LightKind::Directional);
        c.needs("lamp position", "light=point", self.kind == LightKind::Point);
    }

    /// Declares all controls except the choice between the two, for a chapter where both can shine.
    pub fn controls_of_both(&mut self, c: &mut Controls) {
        c.sun(&mut self.sun);
        c.vector("lamp position", &mut self.lamp.position, -100.0..=100.0);
    }

    /// The light that shines, for shaders.
    pub fn shader(&self) -> Light {
        match self.kind {
            LightKind::Directional => Light::directional(&self.sun),
            LightKind::Point => Light::point(&self.lamp),
        }
    }

    /// Sun and lamp.
    pub fn both(&self) -> [Light; 2] {
        [Light::directional(&self.sun), Light::point(&self.lamp)]
    }
}
