//! The tree of nodes: where each mesh, camera and light of a scene is.

use anyhow::{Result, ensure};
use glam::{DMat4, DQuat, DVec3, DVec4, Quat, Vec3};
use gltf::json::{Index, Node, Root};

use super::features::Features;

/// A node with its place in the world.
#[derive(Clone, Copy)]
pub(super) struct Placed<'a> {
    /// Its number in the file.
    pub number: usize,
    pub node: &'a Node,
    /// From its space to the world.
    pub transform: DMat4,
}

/// The nodes of the scene that is shown, parents before their children.
///
/// A node is visited once, so the time is bounded, whatever the file says.
///
/// # Errors
/// If there are no nodes.
pub(super) fn visit<'a>(root: &'a Root, features: &mut Features) -> Result<Vec<Placed<'a>>> {
    let mut stack: Vec<(usize, DMat4)> = Vec::new();
    let push = |list: &[Index<Node>], parent: DMat4, stack: &mut Vec<_>| {
        stack.extend(list.iter().rev().map(|node| (node.value(), parent)));
    };
    match root.scene.and_then(|scene| root.get(scene)).or(root.scenes.first()) {
        Some(scene) => push(&scene.nodes, DMat4::IDENTITY, &mut stack),
        None => {
            let mut is_child = vec![false; root.nodes.len()];
            for child in root.nodes.iter().filter_map(|node| node.children.as_ref()).flatten() {
                if let Some(is_child) = is_child.get_mut(child.value()) {
                    *is_child = true;
                }
            }
            stack.extend(
                (0..root.nodes.len())
                    .rev()
                    .filter(|&node| !is_child[node])
                    .map(|node| (node, DMat4::IDENTITY)),
            );
        }
    }
    if root.scenes.len() > 1 {
        let name = root.scene.map_or(0, |scene| scene.value());
        features.note("scenes", 1, || {
            format!("has {} scenes; scene {name}, its default, is shown", root.scenes.len())
        });
    }
    ensure!(!stack.is_empty(), "has no nodes in its scene, and so nothing to show");
    let mut placed = Vec::new();
    let mut seen = vec![false; root.nodes.len()];
    while let Some((number, parent)) = stack.pop() {
        let Some(node) = root.nodes.get(number) else {
            features.note("node", 1, || {
                let count = root.nodes.len();
                format!(
                    "names node {number}, and there are {count}, counted from 0; it is left out"
                )
            });
            continue;
        };
        if std::mem::replace(&mut seen[number], true) {
            features.note("twice", 1, || {
                format!(
                    "names node {number} twice in the tree of nodes, where each has one parent; the first place counts"
                )
            });
            continue;
        }
        let transform = parent * local(number, node, features);
        placed.push(Placed { number, node, transform });
        if let Some(children) = &node.children {
            push(children, transform, &mut stack);
        }
    }
    Ok(placed)
}

/// From a node's space to its parent's.
fn local(number: usize, node: &Node, features: &mut Features) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        // The last row of a place is 0, 0, 0, 1; that of its transpose has the translation.
        let is_last = |row: DVec4| row == DVec4::W;
        if !is_last(matrix.row(3)) && is_last(matrix.w_axis) {
            features.note("transposed", 1, || {
                format!("the matrix of node {number} is transposed; glTF has columns; it is turned around")
            });
            return matrix.transpose();
        }
        return matrix;
    }
    let translation = Vec3::from(node.translation.unwrap_or_default()).as_dvec3();
    let scale = node.scale.map_or(DVec3::ONE, |scale| Vec3::from(scale).as_dvec3());
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |rotation| {
        let rotation = Quat::from_array(rotation.0).as_dquat();
        // Exporters round to fewer digits than a unit quaternion has.
        if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY }
    });
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}
