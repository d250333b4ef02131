//! The pose of a mesh: its morph targets at their first weights, and its skin on the nodes' joints.

use anyhow::Result;
use glam::{DMat4, DVec3, Vec3};
use gltf::json::mesh::{MorphTarget, Primitive, Semantic};
use gltf::json::{Accessor, Index, Node, Skin};

use super::features::Features;
use super::file::File;
use super::nodes::Placed;

/// The most joints of a skin that move one vertex, in sets of four.
const SETS: u32 = 4;

/// The changes of a mesh that a node shows.
#[derive(Default)]
pub(super) struct Pose {
    /// A weight for each morph target; those beyond are 0.
    weights: Vec<f32>,
    /// For each joint of the skin, from the mesh's space to the world.
    joints: Option<Vec<DMat4>>,
}

impl Pose {
    /// The pose that a node shows its mesh in. `placed` is the place of each node.
    ///
    /// # Errors
    /// If the skin's matrices cannot be read.
    pub fn of(file: &File, node: &Node, placed: &[Option<DMat4>]) -> Result<Self> {
        let mesh = node.mesh.and_then(|mesh| file.root.get(mesh));
        let of_mesh = || mesh.and_then(|mesh| mesh.weights.clone());
        let weights = node.weights.clone().or_else(of_mesh).unwrap_or_default();
        let skin = node.skin.and_then(|skin| file.root.get(skin));
        let joints = skin.map(|skin| joints(file, skin, placed)).transpose()?;
        Ok(Self { weights, joints })
    }

    /// True if it places its vertices in the world itself: then the node's own place does not count.
    pub fn is_in_world(&self) -> bool {
        self.joints.is_some()
    }

    /// True if it leaves the mesh as it is.
    pub fn is_rest(&self) -> bool {
        self.joints.is_none() && self.weights.iter().all(|&weight| weight == 0.0)
    }

    /// Moves the vertices of a primitive.
    ///
    /// # Errors
    /// If the targets, joints or weights cannot be read.
    pub fn apply(
        &self,
        file: &File,
        primitive: &Primitive,
        positions: &mut [Vec3],
        normals: &mut [[f32; 3]],
    ) -> Result<()> {
        let count = positions.len();
        let targets = primitive.targets.as_deref().unwrap_or_default();
        for (MorphTarget { positions: moved, normals: turned, .. }, &weight) in
            targets.iter().zip(&self.weights).filter(|(_, weight)| **weight != 0.0)
        {
            let read = |accessor: &Option<Index<Accessor>>| match accessor {
                Some(accessor) => file.floats::<3>(*accessor, count),
                None => Ok(Vec::new()),
            };
            for (position, by) in positions.iter_mut().zip(read(moved)?) {
                *position += weight * Vec3::from(by);
            }
            for (normal, by) in normals.iter_mut().zip(read(turned)?) {
                *normal = (Vec3::from(*normal) + weight * Vec3::from(by)).to_array();
            }
        }
        let Some(joints) = &self.joints else { return Ok(()) };
        // For each vertex, the sum of its joints' matrices by weight.
        let mut matrices = vec![DMat4::ZERO; positions.len()];
        for set in 0..SETS {
            let indices = file.attribute(primitive, Semantic::Joints(set));
            let weights = file.attribute(primitive, Semantic::Weights(set));
            let (Some(indices), Some(weights)) = (indices, weights) else { break };
            let indices = file.integers::<4>(indices, count)?;
            let weights = file.floats::<4>(weights, count)?;
            for ((matrix, indices), weights) in matrices.iter_mut().zip(indices).zip(weights) {
                for (joint, weight) in indices.into_iter().zip(weights) {
                    if let Some(joint) = joints.get(joint as usize).filter(|_| weight != 0.0) {
                        *matrix += *joint * f64::from(weight);
                    }
                }
            }
        }
        for (position, matrix) in positions.iter_mut().zip(&matrices) {
            let sum = matrix.w_axis.w;
            // A vertex without joints stays where it is.
            if sum != 0.0 {
                let moved = *matrix * position.as_dvec3().extend(1.0);
                *position = (moved.truncate() / sum).as_vec3();
            }
        }
        for (normal, matrix) in normals.iter_mut().zip(&matrices) {
            if matrix.w_axis.w != 0.0 {
                *normal = turned(*matrix, Vec3::from(*normal)).to_array();
            }
        }
        Ok(())
    }
}

/// Notes what would move.
pub(super) fn note(file: &File, placed: &[Placed], features: &mut Features) {
    let animations = file.root.animations.len();
    if animations > 0 {
        features.note("animation", animations, || {
            "has animations; the model stands as its nodes say".to_owned()
        });
    }
    let has_skin = |placed: &&Placed| placed.node.skin.is_some();
    let skins = placed.iter().filter(has_skin).count();
    if skins > 0 {
        features
            .note("skin", skins, || "has a skin; it is shown in the pose of its nodes".to_owned());
    }
    let meshes = placed.iter().filter_map(|placed| file.root.get(placed.node.mesh?));
    let has_targets = |primitive: &Primitive| primitive.targets.is_some();
    let morphs = meshes.filter(|mesh| mesh.primitives.iter().any(has_targets)).count();
    if morphs > 0 {
        features.note("morph", morphs, || {
            "has morph targets; it is shown with their first weights".to_owned()
        });
    }
}

/// For each joint of a skin, from the mesh's space in its bind pose to the world.
fn joints(file: &File, skin: &Skin, placed: &[Option<DMat4>]) -> Result<Vec<DMat4>> {
    let inverse = match skin.inverse_bind_matrices {
        Some(accessor) => file.floats::<16>(accessor, skin.joints.len())?,
        None => Vec::new(),
    };
    let joint = |(number, node): (usize, &Index<Node>)| {
        let place = placed.get(node.value()).copied().flatten().unwrap_or(DMat4::IDENTITY);
        let inverse = inverse.get(number).map(|m| DMat4::from_cols_array(&m.map(f64::from)));
        place * inverse.unwrap_or(DMat4::IDENTITY)
    };
    Ok(skin.joints.iter().enumerate().map(joint).collect())
}

/// A normal after a transform: it turns with the inverse transpose, whose columns are the cross products of the
/// matrix's own, up to a factor.
fn turned(matrix: DMat4, normal: Vec3) -> Vec3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate());
    let n = normal.as_dvec3();
    let turned: DVec3 = y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z;
    let sign = if x.dot(y.cross(z)) < 0.0 { -1.0 } else { 1.0 };
    // Any length will do, but it must not vanish in 32 bits.
    (turned * sign).normalize_or_zero().as_vec3()
}
