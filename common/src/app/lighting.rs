//! The light of a chapter: what may be set of it, and what its shaders get.

use glam::DVec3;

use super::Controls;
use crate::scene::{Light, LightKind, Placement, PointLight, Sun};

/// A sun and a lamp, of which one shines; 05_shadow_miss teaches what its shaders do with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// The sun.
    pub sun: Sun,
    /// The lamp.
    pub lamp: PointLight,
    /// Which of them shines.
    pub kind: LightKind,
    /// Radius of the disk that shines; 0 casts hard shadows.
    pub size: f32,
    /// Shadow rays a hit, where the light has a size.
    pub samples: u32,
}

impl Lighting {
    /// A sun that casts hard shadows, and a lamp over the board that does not shine.
    pub fn new(sun: Sun) -> Self {
        let (lamp, kind) = (PointLight::default(), LightKind::Directional);
        Self { sun, lamp, kind, size: 0.0, samples: 16 }
    }

    // ANCHOR: controls
    /// Declares what may be set.
    pub fn controls(&mut self, c: &mut Controls) {
        c.choice("light", &mut self.kind);
        self.controls_of_both(c);
    }

    /// All but the choice of one, for a chapter where both can shine.
    pub fn controls_of_both(&mut self, c: &mut Controls) {
        c.sun(&mut self.sun);
        c.vector("lamp position", &mut self.lamp.position, -100.0..=100.0);
        c.slider("light size", &mut self.size, 0.0..=1.0);
        c.integer("light samples", &mut self.samples, 1..=64);
    }
    // ANCHOR_END: controls

    /// The light that shines, for shaders.
    pub fn shader(&self) -> Light {
        self.placed(&Placement::default())
    }

    /// The light that shines, where everything is moved.
    pub fn moved(&self, moved: DVec3) -> Light {
        self.placed(&Placement { size: 1.0, moved })
    }

    /// The light that shines, where a placement puts the scene.
    pub fn placed(&self, placement: &Placement) -> Light {
        let [sun, lamp] = self.both(placement);
        match self.kind {
            LightKind::Directional => sun,
            LightKind::Point => lamp,
        }
    }

    /// Sun and lamp, where a placement puts the scene: the lamp's size grows with it.
    pub fn both(&self, placement: &Placement) -> [Light; 2] {
        let sun = Light::directional(&self.sun, self.size);
        let lamp = Light::point(&placement.lamp(&self.lamp), self.size * placement.size as f32);
        [sun, lamp].map(|light| Light { samples: self.samples, ..light })
    }
}
