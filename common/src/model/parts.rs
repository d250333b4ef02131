//! The parts of an OBJ file: the triangles of one object in one material.

use std::collections::{BTreeSet, HashMap};

use glam::{Vec2, Vec3};

use super::obj::{flat_normal, unit};
use super::polygon::Triangulator;
use super::positions::Positions;
use crate::scene::mesh::{Mesh, Vertex};

/// In place of an index that a corner does not have.
pub(crate) const NONE: u32 = u32::MAX;

/// A corner of a face, as positions in the file's lists, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Corner {
    pub position: u32,
    /// Or [`NONE`].
    pub coordinate: u32,
    /// Or [`NONE`].
    pub normal: u32,
}

/// A triangle.
pub(crate) struct Triangle {
    pub corners: [Corner; 3],
    /// Its smoothing group; 0 is none.
    pub smoothing: u32,
}

/// The triangles of one object in one material.
pub(crate) struct Part {
    /// The name of the object or group.
    pub name: String,
    /// The object or group, by its number.
    object: usize,
    /// The material, by its number among the names in `usemtl` statements; [`NONE`] before the first.
    pub material: u32,
    pub triangles: Vec<Triangle>,
}

impl Part {
    /// Adds the triangles of a polygon. Returns true if it crosses itself.
    pub fn add(
        &mut self,
        polygon: &[Corner],
        smoothing: u32,
        positions: &Positions,
        triangulator: &mut Triangulator,
    ) -> bool {
        if let &[a, b, c] = polygon {
            self.triangles.push(Triangle { corners: [a, b, c], smoothing });
            return false;
        }
        let corners: Vec<_> =
            polygon.iter().map(|corner| positions.exact(corner.position)).collect();
        let (cut, crosses) = triangulator.triangulate(&corners);
        let triangle =
            |corners: &[usize; 3]| Triangle { corners: corners.map(|i| polygon[i]), smoothing };
        self.triangles.extend(cut.iter().map(triangle));
        crosses
    }

    /// True if any corner has texture coordinates.
    pub fn has_coordinates(&self) -> bool {
        let has = |corner: &Corner| corner.coordinate != NONE;
        self.triangles.iter().any(|triangle| triangle.corners.iter().any(has))
    }
}

/// The parts found so far. A file may go back and forth between materials before each face: what belongs together
/// is one part.
#[derive(Default)]
pub(crate) struct Parts {
    pub list: Vec<Part>,
    /// The part of each object and material.
    known: HashMap<(usize, u32), usize>,
    /// The number of each group.
    groups: HashMap<String, usize>,
    /// The number of objects and groups.
    objects: usize,
    name: String,
    object: usize,
    material: Option<u32>,
    current: Option<usize>,
}

impl Parts {
    /// Starts an object.
    pub fn start_object(&mut self, name: &str) {
        self.objects += 1;
        self.set(name, self.objects);
    }

    /// Starts a group, or continues the one of this name. Returns true if it is new.
    pub fn start_group(&mut self, name: &str) -> bool {
        // Faces before the first group are in 0, which has no name.
        let known = if name.is_empty() { Some(0) } else { self.groups.get(name).copied() };
        let number = known.unwrap_or_else(|| {
            self.objects += 1;
            self.groups.insert(name.to_owned(), self.objects);
            self.objects
        });
        self.set(name, number);
        known.is_none()
    }

    fn set(&mut self, name: &str, object: usize) {
        name.clone_into(&mut self.name);
        self.object = object;
        self.current = None;
    }

    /// Changes the material.
    pub fn set_material(&mut self, material: u32) {
        self.material = Some(material);
        self.current = None;
    }

    /// The part for the next face, and true if it is new.
    pub fn part(&mut self) -> (&mut Part, bool) {
        let count = self.list.len();
        let material = self.material.unwrap_or(NONE);
        let number = self
            .current
            .unwrap_or_else(|| *self.known.entry((self.object, material)).or_insert(count));
        self.current = Some(number);
        let is_new = number == count;
        if is_new {
            let name = if self.name.is_empty() { "unnamed_object" } else { &self.name };
            let (name, object) = (name.to_owned(), self.object);
            self.list.push(Part { name, object, material, triangles: Vec::new() });
        }
        (&mut self.list[number], is_new)
    }
}

/// The contents of an OBJ file, without its materials.
#[derive(Default)]
pub(crate) struct Geometry {
    pub positions: Positions,
    /// As the file has them: v upwards.
    pub coordinates: Vec<Vec2>,
    /// A vector of any length; zero if the file's is not a direction.
    pub normals: Vec<Vec3>,
    pub parts: Vec<Part>,
}

impl Geometry {
    /// Joins the parts of each object whose materials are the same one, and returns the number of that for each.
    pub fn join(&mut self, material: impl Fn(u32) -> usize) -> Vec<usize> {
        let mut known = HashMap::new();
        let mut joined: Vec<Part> = Vec::new();
        let mut materials = Vec::new();
        for part in std::mem::take(&mut self.parts) {
            let material = material(part.material);
            let of = (part.object, material);
            match known.get(&of) {
                Some(&number) => {
                    let into: &mut Part = &mut joined[number];
                    into.triangles.extend(part.triangles);
                }
                None => {
                    known.insert(of, joined.len());
                    joined.push(part);
                    materials.push(material);
                }
            }
        }
        self.parts = joined;
        materials
    }

    /// The names that several objects have.
    pub fn ambiguous(&self) -> Vec<String> {
        let objects: BTreeSet<_> =
            self.parts.iter().map(|part| (part.name.as_str(), part.object)).collect();
        let names: Vec<_> = objects.into_iter().map(|(name, _)| name).collect();
        let mut names: Vec<_> =
            names.windows(2).filter(|two| two[0] == two[1]).map(|two| two[0].to_owned()).collect();
        names.dedup();
        names
    }

    /// The positions in use.
    pub fn used(&self) -> impl Iterator<Item = u32> {
        let triangles = self.parts.iter().flat_map(|part| &part.triangles);
        triangles.flat_map(|triangle| triangle.corners.map(|corner| corner.position))
    }

    /// A part in its form for shaders: normals of unit length, texture coordinates from the top.
    pub fn mesh(&self, part: Part, material: usize) -> Mesh {
        let mut vertices = Vec::new();
        // The vertex of each corner with a normal; the others stay with their triangle.
        let mut known = HashMap::new();
        let triangles = part.triangles.iter().map(|triangle| {
            let places = triangle.corners.map(|corner| self.positions.rounded(corner.position));
            triangle.corners.map(|corner| {
                let count = vertices.len() as u32;
                let normal =
                    self.normals.get(corner.normal as usize).and_then(|&normal| unit(normal));
                let number = match normal {
                    Some(_) => *known.entry(corner).or_insert(count),
                    None => count,
                };
                if number == count {
                    let uv = self.coordinates.get(corner.coordinate as usize);
                    vertices.push(Vertex {
                        position: self.positions.rounded(corner.position),
                        normal: normal.unwrap_or_else(|| flat_normal(places)),
                        uv: uv.map_or(Vec2::ZERO, |uv| Vec2::new(uv.x, 1.0 - uv.y)),
                    });
                }
                number
            })
        });
        let triangles = triangles.collect();
        Mesh { name: part.name, vertices, triangles, material }
    }
}
