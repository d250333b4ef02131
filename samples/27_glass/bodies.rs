//! Bodies that are made here: turned on a lathe, or cut from a bar. Each is closed, and each of its triangles
//! is counter-clockwise as seen from outside.

use std::f32::consts::{PI, TAU};

use common::scene::{Mesh, Vertex};
use glam::{Vec2, Vec3};

/// Two neighbouring parts of a profile make a smooth edge if the cosine of the angle between them is more.
const SMOOTH: f32 = 0.8;

/// A profile, turned around the y axis. Its points are radius and height, from the axis to the axis, and
/// what it encloses is on its left. The normals are those of the round body.
pub fn turned(name: &str, profile: &[Vec2], segments: u32) -> Mesh {
    let mut mesh = Mesh { name: name.to_owned(), vertices: vec![], triangles: vec![], material: 0 };
    let outward =
        |part: &[Vec2]| Vec2::new(part[1].y - part[0].y, part[0].x - part[1].x).normalize();
    let normals: Vec<Vec2> = profile.windows(2).map(outward).collect();
    for (part, ends) in profile.windows(2).enumerate() {
        let own = normals[part];
        let shared = |other: Option<&Vec2>| match other {
            Some(other) if own.dot(*other) > SMOOTH => (own + *other).normalize(),
            _ => own,
        };
        let at_ends =
            [shared(part.checked_sub(1).map(|i| &normals[i])), shared(normals.get(part + 1))];
        let first = mesh.vertices.len() as u32;
        for segment in 0..segments {
            let angle = TAU * segment as f32 / segments as f32;
            let around = |flat: Vec2| Vec3::new(flat.x * angle.sin(), flat.y, flat.x * angle.cos());
            mesh.vertices.extend((0..2).map(|end| Vertex {
                position: around(ends[end]),
                normal: around(at_ends[end]),
                uv: Vec2::ZERO,
            }));
            let [low, high] = [0, 1].map(|end| first + 2 * segment + end);
            let [low_next, high_next] =
                [0, 1].map(|end| first + 2 * ((segment + 1) % segments) + end);
            // At the axis one of the two triangles has no area.
            if ends[0].x > 0.0 {
                mesh.triangles.push([low, low_next, high]);
            }
            if ends[1].x > 0.0 {
                mesh.triangles.push([high, low_next, high_next]);
            }
        }
    }
    mesh
}

/// A ball of radius 1, whose normals point away from its middle.
pub fn ball(name: &str, segments: u32) -> Mesh {
    let parts = segments / 2;
    let point = |i: u32| {
        let angle = PI * i as f32 / parts as f32;
        // On the axis the radius is 0, whatever the sine is.
        Vec2::new(if i == 0 || i == parts { 0.0 } else { angle.sin() }, -angle.cos())
    };
    let profile: Vec<Vec2> = (0..=parts).map(point).collect();
    let mut mesh = turned(name, &profile, segments);
    mesh.vertices.iter_mut().for_each(|vertex| vertex.normal = vertex.position.normalize());
    mesh
}

/// A bar along z from -1/2 to 1/2; its section is the polygon, whose corners are counter-clockwise.
pub fn bar(name: &str, section: &[Vec2]) -> Mesh {
    let mut mesh = Mesh { name: name.to_owned(), vertices: vec![], triangles: vec![], material: 0 };
    let mut face = |corners: &[Vec3], normal: Vec3| {
        let first = mesh.vertices.len() as u32;
        let vertex = |&position: &Vec3| Vertex { position, normal, uv: Vec2::ZERO };
        mesh.vertices.extend(corners.iter().map(vertex));
        mesh.triangles.extend((2..corners.len() as u32).map(|i| [first, first + i - 1, first + i]));
    };
    let at = |z: f32| section.iter().map(move |corner| corner.extend(z));
    face(&at(0.5).collect::<Vec<_>>(), Vec3::Z);
    face(&at(-0.5).rev().collect::<Vec<_>>(), Vec3::NEG_Z);
    for (i, &a) in section.iter().enumerate() {
        let b = section[(i + 1) % section.len()];
        let normal = Vec2::new(b.y - a.y, a.x - b.x).normalize().extend(0.0);
        face(&[a.extend(-0.5), b.extend(-0.5), b.extend(0.5), a.extend(0.5)], normal);
    }
    mesh
}

/// The corners of a regular polygon with sides of length 1, around the origin, one side at the bottom.
pub fn regular(corners: u32) -> Vec<Vec2> {
    let radius = 0.5 / (PI / corners as f32).sin();
    let corner = |i: u32| {
        let angle = TAU * (i as f32 + 0.5) / corners as f32 - PI / 2.0;
        radius * Vec2::new(angle.cos(), angle.sin())
    };
    (0..corners).map(corner).collect()
}
