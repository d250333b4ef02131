//! The light of a chapter: what may be set of it, and what its shaders get.

use super::Controls;
use crate::scene::{Light, LightKind, PointLight, Sun};

/// A sun and a lamp, of which one shines; 34_lights teaches what its shaders do with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// The sun.
    pub sun: Sun,
    /// The lamp.
    pub lamp: PointLight,
    /// Which of them shines.
    pub kind: LightKind,
}

impl Lighting {
    /// A sun, and a lamp over the board that does not shine.
    pub fn new(sun: Sun) -> Self {
        Self { sun, lamp: PointLight::default(), kind: LightKind::Directional }
    }

    /// Declares what may be set.
    pub fn controls(&mut self, c: &mut Controls) {
        c.choice("light", &mut self.kind);
        self.controls_of_both(c);
    }

    /// All but the choice of one, for a chapter where both can shine.
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
