//! Options of the solids: which, of how many planes, cut, inside out, hollow.

use common::Controls;
use glam::Vec3;

use crate::shapes::SHAPES;
use crate::solid::{Bound, Solid, plane};

common::shader_enum! {
    /// The ways to cut a solid with a plane.
    pub enum Cut { Nothing, ClippedBy, Intersection }
}

/// The user's options for all solids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modifiers {
    /// The one solid of that preset, a number in [`SHAPES`].
    pub shape: u32,
    /// Number of planes of its crystal.
    pub planes: u32,
    /// Its rotation about the vertical, in degrees.
    pub turn: f32,
    /// Inside and outside are exchanged.
    pub inverse: bool,
    /// Fog comes in.
    pub hollow: bool,
    /// The cut through each.
    pub cut: Cut,
    /// The cutting plane in the solid's own space: everything beyond it is removed.
    pub cut_normal: Vec3,
    /// Distance of that plane from the solid's origin.
    pub cut_distance: f32,
    /// Planes that are equal are stored once.
    pub shared: bool,
}

impl Default for Modifiers {
    fn default() -> Self {
        Self {
            shape: 7,
            planes: 20,
            turn: 0.0,
            inverse: false,
            hollow: false,
            cut: Cut::Nothing,
            cut_normal: Vec3::new(1.0, 1.0, 2.0),
            cut_distance: 0.1,
            shared: true,
        }
    }
}

impl Modifiers {
    /// The controls.
    pub fn controls(&mut self, c: &mut Controls) {
        c.one_of("solid", &mut self.shape, &SHAPES);
        c.integer("planes", &mut self.planes, 4..=32);
        c.slider("turn", &mut self.turn, 0.0..=360.0);
        c.checkbox("inverse solids", &mut self.inverse);
        c.checkbox("hollow", &mut self.hollow);
        c.choice("cut", &mut self.cut);
        c.direction("cut normal", &mut self.cut_normal, -1e3..=1e3);
        c.slider("cut distance", &mut self.cut_distance, -1e3..=1e3);
        c.checkbox("shared planes", &mut self.shared);
    }

    /// A solid with its modifiers, and the clip of its surface.
    pub fn of(&self, solid: &Solid, clip: Option<Bound>) -> (Solid, Vec<Bound>) {
        let solid = if self.inverse { solid.clone().inverse() } else { solid.clone() };
        // Without a normal there is neither a plane nor a cut.
        let cut =
            (self.cut_normal != Vec3::ZERO).then(|| plane(self.cut_normal, self.cut_distance));
        match (self.cut, cut) {
            // Surface goes, and none comes in its place: one looks inside.
            (Cut::ClippedBy, Some(cut)) => (solid, clip.into_iter().chain([cut]).collect()),
            // The plane becomes a part of the surface.
            (Cut::Intersection, Some(cut)) => {
                let half_space = Solid::Convex(vec![cut], "red");
                (solid.intersection(half_space), clip.into_iter().collect())
            }
            _ => (solid, clip.into_iter().collect()),
        }
    }
}
