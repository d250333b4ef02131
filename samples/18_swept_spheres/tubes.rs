//! The same strands as triangles: tubes with a number of sides, whose vertices are on the surface.

use std::f32::consts::{PI, TAU};

use common::scene::{Mesh, Vertex};
use glam::{Vec2, Vec3};

use super::strands::{Node, Segment, Strands};

/// A mesh for each material.
///
/// A straight tube's outline lies within that of the strand by up to a part 1 - cos(π/sides) of the radius. Where a
/// chain bends, it has a mitre instead of a ball.
pub fn meshes(strands: &Strands, sides: u32) -> Vec<Mesh> {
    let mut meshes: Vec<Mesh> = Vec::new();
    for chain in chains(&strands.segments) {
        let nodes = &strands.nodes[chain[0].first as usize..][..=chain.len()];
        let material = chain[0].material as usize;
        let known = meshes.iter().position(|mesh| mesh.material == material);
        let at = known.unwrap_or_else(|| {
            let name = format!("strands {material}");
            meshes.push(Mesh { name, vertices: Vec::new(), triangles: Vec::new(), material });
            meshes.len() - 1
        });
        match nodes {
            [a, b] if a == b => ball(&mut meshes[at], a, sides),
            _ => tube(&mut meshes[at], nodes, sides),
        }
    }
    meshes
}

/// Upper bound of their number of triangles.
pub fn count(strands: &Strands, sides: u32) -> usize {
    let rings = |chain: &[Segment]| chain.len() + 1 + 2 * sides.div_ceil(4) as usize;
    chains(&strands.segments).map(|chain| 2 * sides as usize * rings(chain)).sum()
}

/// Segments that follow each other, of one material.
fn chains(segments: &[Segment]) -> impl Iterator<Item = &[Segment]> {
    segments.chunk_by(|a, b| a.first + 1 == b.first && a.material == b.material)
}

/// Rings around each node, across the strand; at both ends, rings over the cap as far as its pole.
fn tube(mesh: &mut Mesh, nodes: &[Node], sides: u32) {
    let direction = |pair: &[Node]| (pair[1].center - pair[0].center).normalize_or_zero();
    let directions: Vec<Vec3> = nodes.windows(2).map(direction).collect();
    let last = directions.len() - 1;
    let mut side = directions[0].any_orthonormal_vector();
    let mut rings = Vec::new();
    for (i, node) in nodes.iter().enumerate() {
        let before = directions[i.saturating_sub(1)];
        let along = (before + directions[i.min(last)]).normalize_or(before);
        let kept = side - side.dot(along) * along;
        side = kept.try_normalize().unwrap_or_else(|| along.any_orthonormal_vector());
        // The angle from the middle of the cap to its end: the body leans, and touches the ball there.
        let steps = if i == 0 || i > last { sides.div_ceil(4) } else { 0 };
        let pair = &nodes[i.min(last)..][..2];
        let lean = (pair[1].radius - pair[0].radius) / (pair[1].center - pair[0].center).length();
        let edge = lean.clamp(-1.0, 1.0).acos();
        for step in 0..=steps {
            let part = step as f32 / steps.max(1) as f32;
            let angle = match i {
                0 => part * edge,
                _ if i > last => edge + part * (PI - edge),
                _ => 0.5 * PI,
            };
            let (sine, height) = (angle.sin(), -angle.cos());
            rings.push((*node, sine, height * along, side, along.cross(side)));
        }
    }
    skin(mesh, sides, rings.len() as u32, |ring, turn| {
        let (Node { center, radius }, sine, height, x, y) = rings[ring as usize];
        let normal = sine * (turn.cos() * x + turn.sin() * y) + height;
        (center + radius * normal, normal)
    });
}

/// Rings from pole to pole, half as many as there are sides.
fn ball(mesh: &mut Mesh, node: &Node, sides: u32) {
    let rings = sides / 2 + 1;
    skin(mesh, sides, rings, |ring, turn| {
        let slope = PI * ring as f32 / (rings - 1) as f32;
        let normal = Vec3::new(slope.sin() * turn.cos(), slope.cos(), -slope.sin() * turn.sin());
        (node.center + node.radius * normal, normal)
    });
}

/// Triangles between rings of points, of which `at` says place and normal.
fn skin(mesh: &mut Mesh, sides: u32, rings: u32, at: impl Fn(u32, f32) -> (Vec3, Vec3)) {
    let first = mesh.vertices.len() as u32;
    for (ring, side) in (0..rings).flat_map(|ring| (0..sides).map(move |side| (ring, side))) {
        let (position, normal) = at(ring, TAU * side as f32 / sides as f32);
        mesh.vertices.push(Vertex { position, normal, uv: Vec2::ZERO });
    }
    for (ring, side) in (1..rings).flat_map(|ring| (0..sides).map(move |side| (ring, side))) {
        let corner = |ring: u32, side: u32| first + ring * sides + side % sides;
        let [a, b] = [corner(ring - 1, side), corner(ring - 1, side + 1)];
        let [c, d] = [corner(ring, side), corner(ring, side + 1)];
        mesh.triangles.extend([[a, b, c], [b, d, c]]);
    }
}
