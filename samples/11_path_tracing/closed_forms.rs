//! Scenes whose light has a closed form: a room, and two squares. 29 has them, too.

use common::model::Model;
use common::scene::{Camera, Instance, Material, Mesh, Scene, Vertex};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3, Vec3Swizzles};

/// Two boxes in a box. Every surface shines with 1/2 and scatters 1/2 of what it meets: so each place sees
/// 1/2 + 1/4 + 1/8 + … = 1, wherever it is and wherever it looks.
pub fn room() -> Scene {
    let half = Vec3::splat(0.5);
    let material = Material {
        name: "half".to_owned(),
        base_color: half,
        emission: half,
        ..Material::default()
    };
    let placed = |size: f32, turn: f32, at: Vec3| Instance {
        mesh: 0,
        transform: Affine3A::from_scale_rotation_translation(
            Vec3::splat(size),
            Quat::from_rotation_y(turn),
            at,
        ),
        material: 0,
        record_offset: 0,
    };
    let instances = vec![
        placed(4.0, 0.0, Vec3::ZERO),
        placed(1.0, 0.4, Vec3::new(-0.6, -1.5, -0.5)),
        placed(0.7, 1.0, Vec3::new(0.7, -0.9, 0.2)),
    ];
    let camera = Camera::new(DVec3::new(0.2, 0.3, 1.9), DVec3::new(0.0, -0.6, 0.0), 70.0);
    let model = Model { meshes: vec![cube()], materials: vec![material], ..Model::default() };
    Scene { model, instances, camera }
}

/// A unit square that shines with 1 and reflects nothing, a unit away from a white one that faces it.
pub fn parallel_squares() -> Scene {
    squares(Vec3::Z, Vec3::X, Vec3::Y, 0.75)
}

/// The same at a right angle to the white one, with a side in common.
pub fn perpendicular_squares() -> Scene {
    squares(Vec3::new(0.0, -0.5, 0.5), Vec3::X, Vec3::Z, 2.0)
}

/// The white square, and one that shines: its middle, and two directions along its sides.
fn squares(middle: Vec3, right: Vec3, up: Vec3, distance: f64) -> Scene {
    let shining = Material {
        name: "shining".to_owned(),
        base_color: Vec3::ZERO,
        emission: Vec3::ONE,
        ..Material::default()
    };
    let mut scene = white_square(distance);
    scene.model.meshes.push(square("shining", 1, middle, right, up));
    scene.model.materials.push(shining);
    scene.instances.push(Instance { mesh: 1, material: 1, ..scene.instances[0] });
    scene
}

/// A white unit square around the origin, which faces +z. The camera sees it whole, and only that.
pub fn white_square(distance: f64) -> Scene {
    let white = Material { name: "white".to_owned(), base_color: Vec3::ONE, ..Material::default() };
    let square = square("white", 0, Vec3::ZERO, Vec3::X, Vec3::Y);
    let instance =
        Instance { mesh: 0, transform: Affine3A::IDENTITY, material: 0, record_offset: 0 };
    let field_of_view = 2.0 * (0.5 / distance).atan().to_degrees();
    Scene {
        model: Model { meshes: vec![square], materials: vec![white], ..Model::default() },
        instances: vec![instance],
        camera: Camera::new(DVec3::new(0.0, 0.0, distance), DVec3::ZERO, field_of_view),
    }
}

/// A unit square, seen from where `right` × `up` points to.
pub fn square(name: &str, material: usize, middle: Vec3, right: Vec3, up: Vec3) -> Mesh {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let vertex = |(x, y): (f32, f32)| Vertex {
        position: middle + x * right + y * up,
        normal: right.cross(up),
        uv: Vec2::ZERO,
    };
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    Mesh { name: name.to_owned(), vertices: corners.map(vertex).into(), triangles, material }
}

/// The unit cube around the origin.
fn cube() -> Mesh {
    let mut cube =
        Mesh { name: "cube".to_owned(), vertices: vec![], triangles: vec![], material: 0 };
    for (out, right) in [Vec3::X, Vec3::Y, Vec3::Z]
        .into_iter()
        .flat_map(|axis| [(axis, axis.zxy()), (-axis, axis.zxy())])
    {
        let first = cube.vertices.len() as u32;
        let side = square("side", 0, 0.5 * out, right, out.cross(right));
        cube.vertices.extend(side.vertices);
        cube.triangles.extend(side.triangles.iter().map(|t| t.map(|corner| corner + first)));
    }
    cube
}
