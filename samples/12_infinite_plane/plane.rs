//! The infinite plane and the board that lies on it: what may be set, and what the shaders get of it.

use common::Controls;
use common::scene::Placement;
use common::scene::board::Board;
use common::scene::plane::{HalfSpace, Plane};
use glam::{DVec3, Vec3};

/// A plane without end, as a scene has it beside its triangles.
pub struct InfinitePlane {
    /// Whether it is there.
    pub exists: bool,
    /// The plane is the surface of this.
    pub half_space: HalfSpace,
    /// What is seen of it from inside: its surface (0), a colour (1), nothing (2).
    pub inside: u32,
    /// What lies on it.
    pub board: Board,
}

impl InfinitePlane {
    /// The surface of a half-space, with a board on it.
    pub fn new(half_space: HalfSpace, board: Board) -> Self {
        Self { exists: true, half_space, inside: 0, board }
    }

    // ANCHOR: controls
    /// Declares what may be set.
    pub fn controls(&mut self, c: &mut Controls) {
        let Self { exists, half_space, inside, board } = self;
        c.checkbox("plane", exists);
        let forms = ["normal and distance", "point and normal"];
        c.choice("plane form", &mut half_space.form, &forms);
        c.vector("plane normal", &mut half_space.normal, -1e3..=1e3);
        c.slider("plane distance", &mut half_space.distance, -1e6..=1e6);
        c.vector("plane point", &mut half_space.point, -1e6..=1e6);
        c.checkbox("inverse", &mut half_space.inverse);
        c.choice("inside", inside, &["surface", "color", "through"]);
        c.color("inside color", &mut board.inner);
        c.choice("checker", &mut board.checker, &["filtered", "point", "off"]);
        c.color("light squares", &mut board.light);
        c.color("dark squares", &mut board.dark);
        c.slider("square", &mut board.square, 0.01..=100.0);
        c.slider("plane reflection", &mut board.reflection, 0.0..=1.0);
        c.slider("plane specular", &mut board.specular, 0.0..=1.0);
        c.slider("plane roughness", &mut board.roughness, 0.05..=1.0);
    }
    // ANCHOR_END: controls

    /// What `INSIDE` is in the shaders: 0 if there is no plane. A normal of length 0 has none.
    pub fn rule(&self) -> u32 {
        if self.exists && self.half_space.normal != Vec3::ZERO { self.inside + 1 } else { 0 }
    }

    /// Plane and board for shaders whose camera is at `eye`.
    pub fn for_shaders(&self, eye: Vec3) -> (Plane, Board) {
        let placement = Placement::default();
        // Without a plane, any will do that no ray is tested against.
        let placed = self.half_space.placed(&placement).unwrap_or((DVec3::Y, 0.0));
        let plane = Plane::new(placed, eye);
        (plane, self.board.placed(&placement, &self.half_space, &plane))
    }
}
