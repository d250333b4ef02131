//! The elements of an OBJ file: positions, texture coordinates, normals and faces.

use anyhow::{Result, ensure};
use glam::{Vec2, Vec3};

use super::face::corner;
use super::number::{numbers, words};
use super::obj_check::Check;
use super::text::Statement;
use super::warnings::Kind;

/// The most corners of one face.
const CORNERS: usize = 1024;

impl Check<'_> {
    /// Adds a position. A wrong one keeps its number, so that those after it keep theirs.
    pub fn position(&mut self, rest: &str, statement: &Statement) {
        self.tally.positions += 1;
        match self.checked_position(rest, statement) {
            Ok((position, has_w)) => self.geometry.positions.push(position, rest, has_w),
            Err(what) => {
                self.geometry.positions.push_wrong();
                self.leave_out(Kind::Position, "", statement, what);
            }
        }
    }

    /// A position in 32 bits, and true if it was divided by a `w`.
    fn checked_position(
        &mut self,
        rest: &str,
        statement: &Statement,
    ) -> Result<(Vec3, bool), String> {
        const FORMS: &str = "x y z, x y z w or x y z r g b is right";
        let mut values = [0.0; 4];
        let count = numbers("v", rest, &mut values)?;
        let mut position = Vec3::from_slice(&values);
        match count {
            0..3 => return Err(format!("v has {count} numbers; {FORMS}")),
            3 => {}
            4 => {
                position /= values[3];
                if !position.is_finite() {
                    return Err("a position divided by its w is not finite".to_owned());
                }
            }
            // The last 3 are a colour.
            6 | 7 => self.warnings.add(Kind::Color, statement, || {
                "v has a colour, and colours of vertices are not shown; write a material or a texture"
            }),
            _ => {
                let what = || format!("v has {count} numbers; {FORMS}; the first 3 are taken");
                self.warnings.add_word(Kind::Count, "v", statement, what);
            }
        }
        Ok((position, count == 4))
    }

    pub fn coordinate(&mut self, rest: &str, statement: &Statement) -> Result<Vec2, String> {
        let mut values = [0.0; 3];
        match numbers("vt", rest, &mut values)? {
            0 => return Err("vt has no numbers; u, u v or u v w is right".to_owned()),
            1..=3 => {}
            count => self.warnings.add_word(Kind::Count, "vt", statement, || {
                format!("vt has {count} numbers; u, u v or u v w is right; the first 2 are taken")
            }),
        }
        Ok(Vec2::from_slice(&values))
    }

    pub fn normal(&mut self, rest: &str, statement: &Statement) -> Result<Vec3, String> {
        let mut values = [0.0; 3];
        match numbers("vn", rest, &mut values)? {
            3 if values == [0.0; 3] => return Err("vn is 0 0 0, which has no direction".to_owned()),
            3 => {}
            count @ 0..3 => return Err(format!("vn has {count} numbers; x y z is right")),
            count => self.warnings.add_word(Kind::Count, "vn", statement, || {
                format!("vn has {count} numbers; x y z is right; the first 3 are taken")
            }),
        }
        Ok(Vec3::from(values))
    }

    pub fn face(&mut self, rest: &str, statement: &Statement) -> Result<()> {
        let mut corners = Vec::with_capacity(4);
        for word in words(rest) {
            ensure!(
                corners.len() < CORNERS,
                "a face has more than {CORNERS} corners, the most that are read"
            );
            let corner = corner(word, &self.tally, |kind, what| {
                self.warnings.add(kind, statement, || what);
            });
            match corner {
                Ok(corner) => corners.push(corner),
                Err(what) => {
                    self.leave_out(Kind::Face, "", statement, what);
                    return Ok(());
                }
            }
        }
        if corners.len() < 3 {
            let what = format!("a face has {} corners; it needs at least 3", corners.len());
            self.leave_out(Kind::Face, "", statement, what);
            return Ok(());
        }
        // The warning about the position says that they are left out.
        if corners.iter().any(|corner| self.geometry.positions.is_wrong(corner.position)) {
            return Ok(());
        }
        self.tally.faces += 1;
        self.tally.corners += corners.len();
        self.tally.triangles += corners.len() - 2;
        let (part, is_new) = self.parts.part();
        let name = part.name.len();
        if self.tally.bytes() <= self.limits.memory {
            let positions = &self.geometry.positions;
            if part.add(&corners, self.smoothing, positions, &mut self.triangulator) {
                self.warnings.add(
                    Kind::Crossing,
                    statement,
                    || "a face crosses itself; write triangles",
                );
            }
        }
        if is_new { self.count_mesh(name) } else { Ok(()) }
    }
}
