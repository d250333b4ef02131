//! The scenes of this chapter: one to look at, and four whose light is known without a path.

use anyhow::Result;
use common::scene::{Camera, Instance, Material, Mesh, Model, PointLight, Scene, Sun, Vertex};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3, Vec3Swizzles};

common::shader_enum! {
    /// The names of the scenes.
    pub enum SceneName {
        /// A game, with kings and queens of metal.
        Chess,
        /// The same in white that swallows nothing, under a white sky.
        Furnace,
        /// The same with a polish on the white.
        PolishedFurnace,
        /// A room whose surfaces all shine and reflect alike.
        ClosedRoom,
        /// A square that shines, a unit away from one that does not.
        ParallelSquares,
        /// A square that shines at a right angle to one that does not.
        PerpendicularSquares,
    }
    /// What a ray sees that meets nothing.
    pub enum Sky: SKY { Day, White, Black }
}

/// What stands where, how it is looked at, and what lights it.
pub struct Staged {
    /// What is placed, and the view.
    pub scene: Scene,
    /// The sun.
    pub sun: Sun,
    /// The lamp.
    pub lamp: PointLight,
    /// The sky.
    pub sky: Sky,
}

/// The chess set of metal, the black men painted red.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess_of_metal()?;
    for material in scene.model.materials.iter_mut().filter(|material| material.name == "black") {
        material.base_color = Vec3::new(0.5, 0.035, 0.02);
    }
    scene.camera = Camera::new(DVec3::new(6.4, 2.5, -2.7), DVec3::new(0.2, 0.3, -1.1), 33.0);
    Ok(scene)
}

impl Staged {
    /// The scene of a name; `source` is what those of chess are made from.
    pub fn new(name: SceneName, source: &Scene) -> Self {
        let sun = Sun { azimuth: 150.0, elevation: 24.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        if name == SceneName::Chess {
            let lamp = PointLight::default();
            return Self { scene: source.clone(), sun, lamp, sky: Sky::Day };
        }
        let (scene, sky) = match name {
            SceneName::Chess | SceneName::Furnace => (white(source, false), Sky::White),
            SceneName::PolishedFurnace => (white(source, true), Sky::White),
            SceneName::ClosedRoom => (room(), Sky::Black),
            SceneName::ParallelSquares => (squares(Vec3::Z, Vec3::X, Vec3::Y, 0.75), Sky::Black),
            SceneName::PerpendicularSquares => {
                (squares(Vec3::new(0.0, -0.5, 0.5), Vec3::X, Vec3::Z, 2.0), Sky::Black)
            }
        };
        // No light but what the closed form has.
        let sun = Sun { radiance: Vec3::ZERO, ..sun };
        let lamp = PointLight { intensity: Vec3::ZERO, ..PointLight::default() };
        Self { scene, sun, lamp, sky }
    }
}

// ANCHOR: white
/// A scene in white: what a surface does not mirror, it scatters, and it swallows nothing.
fn white(source: &Scene, polished: bool) -> Scene {
    let mut scene = source.clone();
    for material in &mut scene.model.materials {
        *material = Material {
            name: material.name.clone(),
            base_color: Vec3::ONE,
            specular: Vec3::splat(if polished { 0.1 } else { 0.0 }),
            illumination: if polished { 3 } else { 1 },
            ..Material::default()
        };
    }
    scene
}
// ANCHOR_END: white

// ANCHOR: room
/// Two boxes in a box. Every surface shines with 1/2 and scatters 1/2 of what it meets: so each place sees
/// 1/2 + 1/4 + 1/8 + … = 1, wherever it is and wherever it looks.
fn room() -> Scene {
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
    scene(vec![cube()], vec![material], instances, camera)
}
// ANCHOR_END: room

// ANCHOR: squares
/// A white unit square around the origin, which faces +z, and one that shines with 1 and reflects nothing:
/// its middle, and two directions along its sides. The camera sees the first square whole, and only that.
fn squares(middle: Vec3, right: Vec3, up: Vec3, distance: f64) -> Scene {
    let white = Material { name: "white".to_owned(), base_color: Vec3::ONE, ..Material::default() };
    let shining = Material {
        name: "shining".to_owned(),
        base_color: Vec3::ZERO,
        emission: Vec3::ONE,
        ..Material::default()
    };
    let meshes = vec![
        square("white", 0, Vec3::ZERO, Vec3::X, Vec3::Y),
        square("shining", 1, middle, right, up),
    ];
    let instances = (0..2).map(|mesh| Instance {
        mesh,
        transform: Affine3A::IDENTITY,
        material: mesh,
        record_offset: 0,
    });
    let field_of_view = 2.0 * (0.5 / distance).atan().to_degrees();
    let camera = Camera::new(DVec3::new(0.0, 0.0, distance), DVec3::ZERO, field_of_view);
    scene(meshes, vec![white, shining], instances.collect(), camera)
}
// ANCHOR_END: squares

fn scene(
    meshes: Vec<Mesh>,
    materials: Vec<Material>,
    instances: Vec<Instance>,
    camera: Camera,
) -> Scene {
    Scene { model: Model { meshes, materials, ..Model::default() }, instances, camera }
}

/// A unit square, seen from where `right` × `up` points to.
fn square(name: &str, material: usize, middle: Vec3, right: Vec3, up: Vec3) -> Mesh {
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
