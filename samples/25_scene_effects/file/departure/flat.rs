//! Flat surfaces: the faces of boxes, of solids and of meshes.

use std::cmp::Reverse;

use common::model::text::quoted;
use common::scene::{Instance, Scene};
use glam::{Affine3A, Mat3A, Vec3, Vec3A};

use super::{LARGEST, PART, ROUNDING, Thing, brief, lost};
use crate::{Box, Face, Solid};

/// A triangle whose area is less than this part of its longest side's square is not looked at: hardly any ray
/// meets it.
const SLIVER: f32 = 0.01;

/// The number of triangles checked, counted once for each object that may be on their mesh.
const TRIANGLES: usize = 1 << 24;

/// A face: it has a bounding box, and belongs to a body with a bounding sphere.
struct Flat {
    point: Vec3,
    /// A unit vector.
    normal: Vec3,
    bounds: (Vec3, Vec3),
    radius: f32,
}

impl Flat {
    /// The height at which rays start, if a thing stands on this face and loses its shadow by that. `departure` is
    /// the height at a point.
    fn height(&self, thing: &Thing, departure: impl Fn(Vec3) -> f32) -> Option<f32> {
        let above = self.normal.dot(thing.center - self.point);
        if !(above.is_finite() && thing.radius < self.radius) {
            return None;
        }
        let height = departure(thing.center - above * self.normal);
        let reach = Vec3::splat(thing.radius + height);
        let (low, high) = self.bounds;
        let is_over =
            (thing.center + reach).cmpge(low).all() && (thing.center - reach).cmple(high).all();
        let stands = is_over && above.abs() - thing.radius <= height;
        (stands && height > PART * thing.size).then_some(height)
    }
}

/// Half the diagonal of a box.
fn radius((low, high): (Vec3, Vec3)) -> f32 {
    low.distance(high) / 2.0
}

fn reach((low, high): (Vec3, Vec3)) -> f32 {
    low.abs().max(high.abs()).max_element()
}

/// The message for a thing on one of several bodies that all grow with the distance from the origin.
fn told(surface: &str, height: f32, thing: &Thing) -> String {
    let most = brief(height / (PART * thing.size));
    let what = lost(surface, height, thing);
    format!("{what}; what is {most} times smaller and nearer to the origin is right")
}

/// The bodies that reach farthest, by number.
fn farthest(bounds: impl Iterator<Item = (Vec3, Vec3)>) -> impl Iterator<Item = usize> {
    let reaches: Vec<u32> = bounds.map(|bounds| reach(bounds).to_bits()).collect();
    let mut order: Vec<usize> = (0..reaches.len()).collect();
    order.sort_by_key(|&number| Reverse(reaches[number]));
    order.into_iter().take(LARGEST)
}

/// The number of a box from which rays start too high for an object on it, and the message.
pub(super) fn block(boxes: &[Box], things: &[Thing]) -> Option<(usize, String)> {
    farthest(boxes.iter().map(|block| (block.low, block.high))).find_map(|number| {
        let Box { low, high, .. } = boxes[number];
        let found =
            [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [(axis, low), (axis, high)]);
        found.into_iter().find_map(|(normal, point)| {
            let project = |corner: Vec3| corner - normal * normal.dot(corner - point);
            let bounds = (project(low), project(high));
            let face = Flat { point, normal, bounds, radius: radius((low, high)) };
            // As in shaders/25_scene_effects/shape.rchit: the point is on the face.
            let departure = |at: Vec3| ROUNDING * normal.dot(30.0 * at.abs());
            let find = |thing: &Thing| Some((face.height(thing, departure)?, *thing));
            let (height, thing) = things.iter().find_map(find)?;
            Some((number, told("this box", height, &thing)))
        })
    })
}

/// The number of a solid, likewise. `bounds` are the boxes around them.
pub(super) fn solid(
    solids: &[Solid],
    faces: &[Face],
    bounds: &[(Vec3, Vec3)],
    things: &[Thing],
) -> Option<(usize, String)> {
    farthest(bounds.iter().copied()).find_map(|number| {
        let Solid { center, first, count, .. } = solids[number];
        let bounds = bounds[number];
        faces[first as usize..(first + count) as usize].iter().find_map(|wall| {
            let (normal, point) = (wall.normal, center + wall.distance * wall.normal);
            let face = Flat { point, normal, bounds, radius: radius(bounds) };
            // As in shaders/25_scene_effects/solid.rchit.
            let departure = |at: Vec3| {
                let own = 31.0 * at.abs() + 12.0 * at.distance(center);
                ROUNDING * normal.abs().dot(own)
            };
            let find = |thing: &Thing| Some((face.height(thing, departure)?, *thing));
            let (height, thing) = things.iter().find_map(find)?;
            Some((number, told("this solid", height, &thing)))
        })
    })
}

/// The message about a mesh from which rays start too high for an object on it.
pub(super) fn meshes(scene: &Scene, bounds: &[(Vec3, Vec3)], things: &[Thing]) -> Option<String> {
    let mut left = TRIANGLES;
    farthest(bounds.iter().copied()).find_map(|number| {
        let placed = Placed::of(&scene.instances[number]);
        let mesh = &scene.model.meshes[placed.mesh];
        let corner = |index: u32| mesh.vertices[index as usize].position;
        let (low, high) = bounds[number];
        // No triangle of it is larger, or farther away.
        let (size, far) = (low.distance(high), Vec3::splat(reach((low, high))));
        let edges = Vec3A::splat(6.0 * size);
        let most = placed.departure(far, Vec3A::ONE, edges, size * (37.0 + 2.0 / SLIVER));
        let stands = things.iter().filter(|thing| {
            let reach = Vec3::splat(thing.radius + most);
            let is_near =
                (thing.center + reach).cmpge(low).all() && (thing.center - reach).cmple(high).all();
            is_near && thing.radius < radius((low, high)) && most > PART * thing.size
        });
        for thing in stands {
            left = left.checked_sub(mesh.triangles.len())?;
            let height = mesh
                .triangles
                .iter()
                .find_map(|corners| placed.height(corners.map(corner), thing, radius((low, high))));
            if let Some(height) = height {
                let surface = format!("the mesh {}", quoted(&mesh.name));
                return Some(told(&surface, height, thing));
            }
        }
        None
    })
}

/// A mesh where it is placed, as in shaders/common/ray_offset.glsl.
struct Placed {
    mesh: usize,
    to_world: Affine3A,
    to_object: Affine3A,
    linear: Mat3A,
    inverse: Mat3A,
}

impl Placed {
    fn of(instance: &Instance) -> Self {
        let to_world = instance.transform;
        let to_object = to_world.inverse();
        let absolute = |matrix: Mat3A| Mat3A {
            x_axis: matrix.x_axis.abs(),
            y_axis: matrix.y_axis.abs(),
            z_axis: matrix.z_axis.abs(),
        };
        let (linear, inverse) = (absolute(to_world.matrix3), absolute(to_object.matrix3));
        Self { mesh: instance.mesh, to_world, to_object, linear, inverse }
    }

    /// As [`Flat::height`], for a triangle of the mesh.
    fn height(&self, corners: [Vec3; 3], thing: &Thing, radius: f32) -> Option<f32> {
        let [a, b, c] = corners.map(|corner| self.to_world.transform_point3(corner));
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let (across, along) = (b - a, c - a);
        let longest = across.length().max(along.length()).max(along.distance(across));
        let area = across.cross(along);
        let slimness = 2.0 * longest * longest / area.length();
        if slimness.is_nan() || slimness > 2.0 / SLIVER {
            return None;
        }
        let face = Flat { point: a, normal: area.normalize(), bounds: (low, high), radius };
        let edges =
            [across, along].map(|edge| self.to_object.transform_vector3a(edge.into()).abs());
        let edges = self.linear * (edges[0] + edges[1]);
        let test = longest * (37.0 + slimness);
        face.height(thing, |at| self.departure(at, face.normal.abs().into(), edges, test))
    }

    /// The height of a ray's start above a triangle, from the point, the absolute normal, the edges in the mesh's
    /// space as the world has their absolute values, and what the device's test takes.
    fn departure(&self, at: Vec3, normal: Vec3A, edges: Vec3A, test: f32) -> f32 {
        let world = Vec3A::from(at.abs());
        let point = self.to_object.transform_point3a(at.into()).abs();
        let shift = self.to_world.translation.abs();
        let reach = self.linear * point;
        let back = self.inverse * (18.0 * reach + 7.0 * (world + shift));
        let own = reach + 3.0 * edges + 4.0 * (reach + shift) + world + self.linear * back;
        ROUNDING * (normal.dot(own) + test)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use common::model::Model;
    use common::scene::{Camera, Mesh, Vertex};

    const BALL: Thing = Thing { center: Vec3::Y, radius: 1.0, size: 2.0 };

    fn at(height: f32) -> Thing {
        Thing { center: Vec3::Y * (height + 1.0), ..BALL }
    }

    #[test]
    fn a_box_is_told_of_by_the_face_on_which_things_stand() {
        let told = |low: f32, high: f32| {
            let (low, high) = (Vec3::new(-1e6, low, -1e6), Vec3::new(1e6, high, 1e6));
            let block = Box { low, high, material: 0 };
            super::block(&[block], &[at(high.y)])
        };
        // Its point is on the face, however far the others are.
        assert_eq!(told(-1e6, 0.0), None);
        assert_eq!(told(-1.0, 1e4), None);
        let (_, what) = told(-1.0, 1e6).unwrap();
        assert!(
            what.ends_with("what is 14 times smaller and nearer to the origin is right"),
            "{what}"
        );
        let small = Box { low: Vec3::ZERO, high: Vec3::splat(1e6), material: 0 };
        let above = Thing { center: Vec3::new(1.0, 1e6 + 100.0, 1.0), ..BALL };
        assert_eq!(block(&[small], &[above]), None);
    }

    #[test]
    fn a_solid_is_told_of_by_its_size() {
        let told = |distance: f32| {
            let center = Vec3::new(0.0, -distance, 0.0);
            let faces = [Face { normal: Vec3::Y, distance }];
            let solid = Solid { center, first: 0, count: 1, material: 0 };
            let bounds = (center - distance, center + distance);
            super::solid(&[solid], &faces, &[bounds], &[BALL]).map(|(_, what)| what)
        };
        assert_eq!(told(1e5), None);
        assert!(told(1e6).unwrap().contains("this solid start up to 0.72 above it"));
    }

    fn ground(size: f32, transform: Affine3A) -> Scene {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let vertex = |[x, z]: [f32; 2]| Vertex {
            position: size * Vec3::new(x, 0.0, z),
            normal: Vec3::Y,
            uv: glam::Vec2::ZERO,
        };
        let mesh = Mesh {
            name: "ground".to_owned(),
            vertices: corners.map(vertex).to_vec(),
            triangles: vec![[0, 2, 1], [0, 3, 2]],
            material: 0,
        };
        let placed = Instance { mesh: 0, transform, material: 0, record_offset: 0 };
        let model = Model { meshes: vec![mesh], ..Model::default() };
        Scene { model, instances: vec![placed], camera: Camera::default() }
    }

    #[test]
    fn a_mesh_is_told_of_by_its_triangles_and_its_place() {
        let told = |size: f32, transform: Affine3A, thing: Thing| {
            let scene = ground(size, transform);
            meshes(&scene, &scene.bounds_of_instances(), &[thing])
        };
        assert_eq!(told(1e3, Affine3A::IDENTITY, BALL), None);
        let what = told(1e6, Affine3A::IDENTITY, BALL).unwrap();
        assert!(
            what.starts_with("rays that leave the mesh \"ground\" start up to 6.9 above it"),
            "{what}"
        );
        assert_eq!(told(1e6, Affine3A::IDENTITY, at(100.0)), None);
        // Not large, but far away.
        let far = Vec3::new(0.0, 1e6, 0.0);
        let away = Affine3A::from_translation(far);
        assert!(told(10.0, away, at(1e6)).is_some());
        assert_eq!(told(10.0, Affine3A::from_translation(far / 1e3), at(1e3)), None);
        // A small mesh made large.
        assert!(told(1.0, Affine3A::from_scale(Vec3::splat(1e6)), BALL).is_some());
    }
}
