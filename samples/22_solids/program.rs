//! Solids as shaders get them: lists of planes, balls, faces and parts, and a program for each solid.

use common::gpu::Number;
use common::scene::plane::Plane;
use glam::{DVec3, Vec3};

use super::solid::{Ball, Bound, Solid, half_space};

common::shader_enum! {
    /// A surface that bounds a convex part.
    pub enum FaceKind: FACE { Plane, Ball }
}

common::shader_struct! {
    /// One bound of a convex part, as shaders get it.
    pub struct Face {
        /// A plane or a ball.
        pub kind: Number<FaceKind>,
        /// Index of the surface.
        pub index: u32,
        /// -1 if the part is on the side that the plane's normal points to.
        pub side: f32,
    }
}

common::shader_struct! {
    /// A convex part, as shaders get it.
    pub struct Part {
        pub first_face: u32,
        pub face_count: u32,
        pub material: u32,
    }
}

/// Codes of the steps of a program, after the numbers of parts, which are below.
const UNION: u32 = 64;
const INTERSECTION: u32 = 65;
const DIFFERENCE: u32 = 66;
const INVERSE: u32 = 67;
/// As many parts as the shaders have room for.
pub const MAX_PARTS: usize = 24;

/// Solids, flattened: what the buffers hold.
#[derive(Default)]
pub struct Programs {
    pub planes: Vec<Plane>,
    pub balls: Vec<Ball>,
    pub faces: Vec<Face>,
    pub parts: Vec<Part>,
    pub steps: Vec<u32>,
    /// The planes as they were given, turned to one side.
    given: Vec<(Vec3, f32)>,
    /// The solid of each plane: solids are not compared with each other.
    first_plane: usize,
    /// True if equal planes and balls are stored once.
    shared: bool,
}

impl Programs {
    /// None yet; planes and balls that are equal are stored once, or not.
    pub fn new(shared: bool) -> Self {
        Self { shared, ..Self::default() }
    }

    /// Adds the parts of a solid, and its steps in postfix order.
    pub fn add(&mut self, solid: &Solid, material: &impl Fn(&str) -> u32) -> [u32; 4] {
        self.first_plane = self.planes.len();
        let first = [self.parts.len(), self.steps.len()];
        self.flatten(solid, first[0], material);
        let count = [self.parts.len() - first[0], self.steps.len() - first[1]];
        assert!(count[0] <= MAX_PARTS, "a solid has at most {MAX_PARTS} parts");
        [first[0], count[0], first[1], count[1]].map(|number| number as u32)
    }

    /// Adds a convex part that belongs to no program, and returns its number.
    pub fn add_part(&mut self, bounds: &[Bound], material: u32) -> u32 {
        let first_face = self.faces.len() as u32;
        for bound in bounds {
            let face = match bound {
                Bound::Plane(normal, distance) => self.plane(*normal, *distance),
                Bound::Ball(ball) => self.ball(*ball),
            };
            self.faces.push(face);
        }
        self.parts.push(Part { first_face, face_count: bounds.len() as u32, material });
        self.parts.len() as u32 - 1
    }

    fn flatten(&mut self, solid: &Solid, first: usize, material: &impl Fn(&str) -> u32) {
        let (both, step) = match solid {
            Solid::Convex(bounds, name) => {
                let part = self.add_part(bounds, material(name));
                return self.steps.push(part - first as u32);
            }
            Solid::Inverse(solid) => {
                self.flatten(solid, first, material);
                return self.steps.push(INVERSE);
            }
            Solid::Union(both) => (both, UNION),
            Solid::Intersection(both) => (both, INTERSECTION),
            Solid::Difference(both) => (both, DIFFERENCE),
        };
        both.iter().for_each(|solid| self.flatten(solid, first, material));
        self.steps.push(step);
    }

    /// The face of a half-space. A plane that the solid has already is stored once, whichever side of it
    /// is meant and however long the normal is: rays cannot meet the two at different t.
    ///
    /// Two normals are parallel where all products are equal crosswise. Products of 32-bit numbers are
    /// exact in 64 bits, so that is no matter of a tolerance.
    fn plane(&mut self, normal: Vec3, distance: f32) -> Face {
        let parts = normal.to_array();
        let side = parts.into_iter().find(|part| *part != 0.0).unwrap_or(1.0).signum();
        let (normal, distance) = (normal * side, distance * side);
        let same = |&(other, at): &(Vec3, f32)| {
            let crosswise = normal.as_dvec3().cross(other.as_dvec3());
            at == distance && crosswise == DVec3::ZERO
        };
        let known = self.given[self.first_plane..].iter().position(same).filter(|_| self.shared);
        let index = known.map_or(self.planes.len(), |known| self.first_plane + known);
        if known.is_none() {
            self.given.push((normal, distance));
            // The solid's own middle is near enough to all of it.
            self.planes.push(Plane::new(half_space(normal, distance), Vec3::ZERO));
        }
        Face { kind: FaceKind::Plane.into(), index: index as u32, side }
    }

    fn ball(&mut self, ball: Ball) -> Face {
        let known = self.balls.iter().position(|known| *known == ball).filter(|_| self.shared);
        let index = known.unwrap_or(self.balls.len());
        if known.is_none() {
            self.balls.push(ball);
        }
        Face { kind: FaceKind::Ball.into(), index: index as u32, side: 1.0 }
    }
}
