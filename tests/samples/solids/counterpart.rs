//! Solids in the reference's form.

use glam::Vec3;
use reference::solid::Solid as ReferenceSolid;
use reference::sphere::Sphere;

use super::program::{Face, FaceKind, Programs};
use super::solid::{self, Bound, Solid, block};

/// Solids in the reference's form, with the same numbers as the shaders.
struct Translator {
    programs: Programs,
}

impl Translator {
    fn new() -> Self {
        Self { programs: Programs::new(true) }
    }

    fn face(&self, face: &Face) -> ReferenceSolid {
        let index = face.index as usize;
        if face.kind == FaceKind::Ball {
            let ball = self.programs.balls[index];
            let (center, radius) = (ball.center.as_dvec3(), ball.radius.into());
            return ReferenceSolid::Ball(Sphere { center, radius });
        }
        let plane = self.programs.planes[index];
        let side = f64::from(face.side);
        let offset = f64::from(plane.distance.x) + f64::from(plane.distance.y);
        ReferenceSolid::HalfSpace { normal: plane.normal.as_dvec3() * side, offset: offset * side }
    }

    fn part(&self, number: u32) -> ReferenceSolid {
        let part = self.programs.parts[number as usize];
        let faces = part.first_face..part.first_face + part.face_count;
        ReferenceSolid::Intersection(
            faces.map(|face| self.face(&self.programs.faces[face as usize])).collect(),
        )
    }

    fn clip(&mut self, bounds: &[Bound]) -> ReferenceSolid {
        let part = self.programs.add_part(bounds, 0);
        self.part(part)
    }

    fn solid(&mut self, solid: &Solid) -> ReferenceSolid {
        let [mut part, ..] = self.programs.add(solid, &|_| 0);
        self.tree(solid, &mut part)
    }

    fn tree(&self, solid: &Solid, next: &mut u32) -> ReferenceSolid {
        let mut both = |solids: &[Solid; 2]| [0, 1].map(|i| self.tree(&solids[i], next));
        match solid {
            Solid::Convex(..) => {
                *next += 1;
                self.part(*next - 1)
            }
            Solid::Union(solids) => ReferenceSolid::Union(both(solids).into()),
            Solid::Intersection(solids) => ReferenceSolid::Intersection(both(solids).into()),
            Solid::Difference(solids) => {
                let [from, what] = both(solids);
                ReferenceSolid::difference(from, what)
            }
            Solid::Inverse(solid) => ReferenceSolid::Inverse(Box::new(self.tree(solid, next))),
        }
    }
}

/// A solid and its clip.
pub fn counterpart(solid: &Solid, clip: &[Bound]) -> [ReferenceSolid; 2] {
    let mut translator = Translator::new();
    [translator.solid(solid), translator.clip(clip)]
}

/// The largest box, which bounds unbounded solids.
pub fn largest() -> Vec<Bound> {
    block(Vec3::splat(-solid::REACH), Vec3::splat(solid::REACH))
}
