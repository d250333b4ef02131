//! The infinite plane and the board on it: their controls, and the values passed to the shaders.

use common::Controls;
use common::scene::Placement;
use common::scene::board::Board;
use common::scene::plane::{HalfSpace, Plane, PlaneForm};
use glam::{DVec3, Vec3};

common::shader_enum! {
    /// The look of the plane from inside: its surface, a colour of its own, or nothing.
    pub enum Inside: INSIDE { Surface, Color, Through }
}

/// A plane without end, as a scene has it beside its triangles.
pub struct InfinitePlane {
    /// True if there is a plane.
    pub exists: bool,
    /// The plane is the surface of this.
    pub half_space: HalfSpace,
    /// The look of the plane from inside.
    pub inside: Inside,
    /// The board on it.
    pub board: Board,
}

impl InfinitePlane {
    /// The surface of a half-space, with a board on it.
    pub fn new(half_space: HalfSpace, board: Board) -> Self {
        Self { exists: true, half_space, inside: Inside::Surface, board }
    }

    /// Declares what may be set.
    pub fn controls(&mut self, c: &mut Controls) {
        let Self { exists, half_space, inside, board } = self;
        c.checkbox("plane", exists);
        c.choice("plane form", &mut half_space.form);
        c.direction("plane normal", &mut half_space.normal, -1e3..=1e3);
        c.slider("plane distance", &mut half_space.distance, -1e6..=1e6);
        c.vector("plane point", &mut half_space.point, -1e6..=1e6);
        let by_point = half_space.form == PlaneForm::PointAndNormal;
        c.needs("plane point", "plane form=point and normal", by_point);
        c.needs("plane distance", "plane form=normal and distance", !by_point);
        c.checkbox("inverse", &mut half_space.inverse);
        c.choice("inside", inside);
        c.color("inside color", &mut board.inner);
        c.needs("inside color", "inside=color", *inside == Inside::Color);
        let mut checker = board.checker == 1;
        c.checkbox("checker", &mut checker);
        board.checker = checker.into();
        c.color("light squares", &mut board.light);
        c.color("dark squares", &mut board.dark);
        c.slider("square", &mut board.square, 0.01..=100.0);
        c.slider("plane reflection", &mut board.reflection, 0.0..=1.0);
        c.slider("plane specular", &mut board.specular, 0.0..=1.0);
        c.slider("plane roughness", &mut board.roughness, 0.05..=1.0);
    }

    /// Tests whether there is a plane: a normal of length 0 has none.
    pub fn is_there(&self) -> bool {
        self.exists && self.half_space.normal != Vec3::ZERO
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
