//! A primitive: the triangles of one material, in their form for shaders.

use anyhow::{Context, Result, ensure};
use glam::{Vec2, Vec3};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use super::features::Features;
use super::file::File;
use super::material::Coordinates;
use super::pose::Pose;
use crate::model::obj::{flat_normal, unit};
use crate::model::text::quoted;
use crate::scene::mesh::{Mesh, Vertex};

impl File {
    /// The accessor of an attribute.
    pub fn attribute(
        &self,
        primitive: &Primitive,
        semantic: Semantic,
    ) -> Option<gltf::json::Index<gltf::json::Accessor>> {
        primitive.attributes.get(&Checked::Valid(semantic)).copied()
    }

    /// The mesh of a primitive in a pose.
    ///
    /// Without normals its triangles are flat, as glTF demands. A triangle is left out if an index leads nowhere or
    /// a position is not finite.
    ///
    /// # Errors
    /// If it has no triangles, or their data cannot be read.
    pub fn mesh(
        &self,
        name: &str,
        primitive: &Primitive,
        coordinates: &Coordinates,
        pose: &Pose,
        features: &mut Features,
    ) -> Result<Mesh> {
        let Checked::Valid(mode) = primitive.mode else {
            anyhow::bail!("it has a mode that glTF 2 does not have");
        };
        let positions = self.attribute(primitive, Semantic::Positions);
        let positions = positions.context("it has no positions")?;
        let count = usize::try_from(self.count(positions)?)?;
        let mut positions: Vec<_> =
            self.floats::<3>(positions, count)?.into_iter().map(Vec3::from).collect();
        let mut normals = self.of_vertices::<3>(primitive, Semantic::Normals, count, features);
        pose.apply(self, primitive, &mut positions, &mut normals)?;
        let set = Semantic::TexCoords(coordinates.set);
        let uvs = self.of_vertices::<2>(primitive, set, count, features);
        if uvs.is_empty() && coordinates.is_read {
            let (set, name) = (coordinates.set, quoted(name));
            if coordinates.are_of_normals {
                features.note("unmapped", 1, || {
                    format!("mesh {name} has a normal map and no TEXCOORD_{set}; it is smooth")
                });
            } else {
                features.note("untextured", 1, || {
                    format!("mesh {name} has a texture and no TEXCOORD_{set}; one texel colours it")
                });
            }
        }
        let indices: Vec<u32> = match primitive.indices {
            Some(indices) => {
                let count = usize::try_from(self.count(indices)?)?;
                self.integers::<1>(indices, count)?.into_iter().map(|[i]| i).collect()
            }
            None => (0..count as u32).collect(),
        };
        let whole = triangles(mode, &indices);
        ensure!(!whole.is_empty(), "it has no triangles");
        let is_whole = |triangle: &&[u32; 3]| {
            let position = |&i: &u32| positions.get(i as usize).is_some_and(|at| at.is_finite());
            triangle.iter().all(position)
        };
        let kept: Vec<[u32; 3]> = whole.iter().filter(is_whole).copied().collect();
        if kept.len() < whole.len() {
            features.note("triangles", whole.len() - kept.len(), || {
                format!("mesh {} has triangles with indices or positions that are wrong; they are left out", quoted(name))
            });
        }
        ensure!(!kept.is_empty(), "it has no triangle whose indices and positions are right");
        let is_blind =
            |normal: &&[f32; 3]| unit(Vec3::from(**normal)).is_none_or(|n| !n.is_finite());
        let blind = normals.iter().filter(is_blind).count();
        if blind > 0 {
            features.note("normals", blind, || {
                let mesh = quoted(name);
                format!("mesh {mesh} has normals without a direction; the triangle's own stands for each")
            });
        }
        let mut vertices = Vec::new();
        // The vertex of each corner with a normal; the others stay with their triangle.
        let mut known = vec![u32::MAX; count];
        let triangles = kept.iter().map(|corners| {
            let places = corners.map(|i| positions[i as usize]);
            corners.map(|corner| {
                let corner = corner as usize;
                let next = vertices.len() as u32;
                let normal = normals.get(corner).and_then(|&normal| unit(Vec3::from(normal)));
                let normal = normal.filter(|normal| normal.is_finite());
                if normal.is_some() && known[corner] != u32::MAX {
                    return known[corner];
                }
                if normal.is_some() {
                    known[corner] = next;
                }
                let uv = uvs.get(corner).map_or(Vec2::ZERO, |&uv| coordinates.of(Vec2::from(uv)));
                vertices.push(Vertex {
                    position: positions[corner],
                    normal: normal.unwrap_or_else(|| flat_normal(places)),
                    uv: if uv.is_finite() { uv } else { Vec2::ZERO },
                });
                next
            })
        });
        let triangles = triangles.collect();
        Ok(Mesh { name: name.to_owned(), vertices, triangles, material: 0 })
    }

    /// An attribute of the vertices; none if it is missing, or does not have one element for each.
    fn of_vertices<const N: usize>(
        &self,
        primitive: &Primitive,
        semantic: Semantic,
        count: usize,
        features: &mut Features,
    ) -> Vec<[f32; N]> {
        let name = semantic.to_string();
        let Some(accessor) = self.attribute(primitive, semantic) else { return Vec::new() };
        let values = self.floats::<N>(accessor, count);
        values.unwrap_or_else(|error| {
            features.note("attribute", 1, || format!("{name} is left out: {error}"));
            Vec::new()
        })
    }
}

/// The triangles that a list of vertices forms; none for points and lines.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::Triangles => indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        // Every second one runs the other way round.
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            .map(
                |(number, c)| if number % 2 == 0 { [c[0], c[1], c[2]] } else { [c[0], c[2], c[1]] },
            )
            .collect(),
        Mode::TriangleFan => match indices {
            [first, rest @ ..] => rest.windows(2).map(|c| [c[0], c[1], *first]).collect(),
            [] => Vec::new(),
        },
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}
