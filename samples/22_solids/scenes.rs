//! The scenes of this chapter: solids on the board, among a few pieces or alone.

use anyhow::Result;
use common::model::Model;
use common::scene::{Camera, Instance, Material, Scene, Sun};
use glam::{Affine3A, DVec3, Mat3A, Quat, Vec3};

use crate::fog::Fog;
use crate::modifiers::Modifiers;
use crate::shapes;
use crate::solid::{Bound, Solid, plane};

common::shader_enum! {
    /// The names of the presets.
    pub enum PresetName { Board, ConvexSolids, Csg, Clipped, Inside, Ties, OneSolid }
}

/// A scene with its lights and its camera.
pub struct Preset {
    /// The placed meshes, and the view.
    pub scene: Scene,
    /// The solids, and from their spaces to the world.
    pub solids: Vec<SolidInstance>,
    /// The sun.
    pub sun: Sun,
    /// The fog in the air.
    pub fog: Fog,
}

/// A solid in the world.
pub struct SolidInstance {
    /// The solid itself.
    pub solid: Solid,
    /// Its place in the world.
    pub transform: Affine3A,
    /// The clip: its surface outside this is left out.
    pub clip: Option<Bound>,
}

/// A material of the solids: name, colour, specular.
struct Paint(&'static str, Vec3, f32);

const PAINTS: [Paint; 5] = [
    Paint("ivory", Vec3::new(0.64, 0.56, 0.43), 0.3),
    Paint("red", Vec3::new(0.6, 0.045, 0.03), 0.5),
    Paint("blue", Vec3::new(0.05, 0.15, 0.46), 0.8),
    Paint("gold", Vec3::new(0.55, 0.32, 0.06), 0.8),
    Paint("silver", Vec3::new(0.42, 0.44, 0.47), 0.8),
];

/// The chess set, seen from a little above the solids.
pub fn chess() -> Result<Scene> {
    let camera = Camera::new(DVec3::new(-1.2, 2.1, 7.6), DVec3::new(0.15, 0.45, 0.0), 36.0);
    Ok(Scene { camera, ..Scene::chess()? })
}

/// Adds what the solids are made of to a model.
pub fn extend(model: &mut Model) {
    for Paint(name, base_color, specular) in &PAINTS {
        model.materials.push(Material {
            name: (*name).to_owned(),
            base_color: *base_color,
            specular: Vec3::splat(*specular),
            shininess: 200.0,
            ..Material::default()
        });
    }
}

/// A material by its name.
pub fn material(model: &Model, name: &str) -> u32 {
    let found = model.materials.iter().position(|material| material.name == name);
    found.unwrap_or(model.materials.len() - 1) as u32
}

impl Preset {
    /// The preset of a name; of `modifiers`, the one solid takes its shape. `scene` lends its pieces.
    pub fn new(name: PresetName, scene: &Scene, modifiers: &Modifiers) -> Self {
        match name {
            PresetName::Board => board(scene),
            PresetName::ConvexSolids => convex_solids(scene),
            PresetName::Csg => csg(scene),
            PresetName::Clipped => clipped(scene),
            PresetName::Inside => inside(scene),
            PresetName::Ties => ties(scene),
            PresetName::OneSolid => one_solid(scene, modifiers),
        }
    }

    /// Solids on the board, with those pieces of the scene whose mesh has such a name.
    fn on_board(
        scene: &Scene,
        pieces: &[&str],
        solids: Vec<SolidInstance>,
        camera: Camera,
    ) -> Self {
        let board = ["board_light", "board_dark", "board_frame"];
        Self::of(scene, &[&board, pieces].concat(), solids, camera)
    }

    /// Solids under the sun, with those instances of the scene whose mesh has such a name.
    fn of(scene: &Scene, stay: &[&str], solids: Vec<SolidInstance>, camera: Camera) -> Self {
        let name = |instance: &Instance| scene.model.meshes[instance.mesh].name.as_str();
        let stays = |instance: &&Instance| stay.contains(&name(instance));
        let instances = scene.instances.iter().filter(stays).copied().collect();
        Self {
            scene: Scene { model: scene.model.clone(), instances, camera },
            solids,
            sun: Sun { azimuth: 305.0, elevation: 34.0, radiance: Vec3::new(4.4, 3.7, 2.8) },
            fog: Fog::default(),
        }
    }
}

/// A solid by its name: its middle, how many times as large, and turned about the vertical, in degrees.
///
/// It sinks in a little: a face in the plane of the board would be two surfaces in one place.
fn at(name: &str, middle: [f32; 3], size: f32, yaw: f32) -> SolidInstance {
    let turn = Quat::from_rotation_y(yaw.to_radians());
    let middle = Vec3::from(middle) - Vec3::Y * 0.01;
    let transform = Affine3A::from_scale_rotation_translation(Vec3::splat(size), turn, middle);
    SolidInstance { solid: shapes::shape(shapes::number(name), 20), transform, clip: None }
}

/// The same, laid onto the face whose normal this is.
fn on_face(name: &str, middle: [f32; 3], size: f32, yaw: f32, face: Vec3) -> SolidInstance {
    let mut instance = at(name, middle, size, yaw);
    let down = Quat::from_rotation_arc(face.normalize(), Vec3::NEG_Y);
    instance.transform.matrix3 *= Mat3A::from_quat(down);
    instance
}

/// Along the normal of a dodecahedron's face.
fn golden() -> Vec3 {
    Vec3::new(0.0, 1.0, 0.5 + 1.25f32.sqrt())
}

/// Solids in front of the kings and queens of the chess set.
fn board(scene: &Scene) -> Preset {
    let mut shell = at("shell", [2.55, 0.5, 1.2], 0.5, 0.0);
    shell.clip = Some(plane(Vec3::new(-0.55, 0.45, 1.0), 0.1));
    let solids = vec![
        at("die", [-0.62, 0.36, 2.75], 0.36, 35.0),
        at("king", [0.5, 0.84, 1.5], 0.6, -24.0),
        at("bishop", [-1.35, 0.78, 1.2], 0.56, 160.0),
        on_face("octahedron", [-1.85, 0.34, 2.5], 0.4, 206.0, Vec3::ONE),
        at("bitten cube", [1.55, 0.36, 2.6], 0.36, -38.0),
        at("tower", [-3.5, 0.7, 0.5], 0.5, 10.0),
        on_face("dodecahedron", [-0.5, 0.5, 0.3], 0.5, 20.0, golden()),
        at("tower", [3.5, 0.7, -1.5], 0.5, -16.0),
        shell,
    ];
    Preset::on_board(scene, &["king", "queen"], solids, scene.camera)
}

/// The five regular solids, and one that is not.
fn convex_solids(scene: &Scene) -> Preset {
    let solids = vec![
        on_face("tetrahedron", [-2.3, 0.35, 1.0], 0.7, 12.0, Vec3::ONE),
        at("cube", [-1.25, 0.45, -0.2], 0.45, 28.0),
        on_face("octahedron", [-0.45, 0.51, 1.2], 0.6, 40.0, Vec3::ONE),
        on_face("dodecahedron", [0.75, 0.62, 0.1], 0.62, 20.0, golden()),
        on_face("icosahedron", [1.75, 0.6, 1.3], 0.6, 10.0, Vec3::ONE),
        at("crystal", [2.75, 0.72, -1.0], 0.7, 0.0),
    ];
    let camera = Camera::new(DVec3::new(-0.9, 2.3, 6.6), DVec3::new(0.15, 0.45, 0.2), 36.0);
    Preset::on_board(scene, &[], solids, camera)
}

/// Union, intersection and difference of cubes, columns and balls.
fn csg(scene: &Scene) -> Preset {
    let solids = vec![
        at("die", [0.0, 0.45, 2.0], 0.45, 30.0),
        at("bitten cube", [1.35, 0.45, 1.2], 0.45, -40.0),
        at("lens", [-1.3, 0.55, 1.3], 0.5, 52.0),
        at("tower", [-1.7, 0.84, -0.4], 0.6, 8.0),
        at("bishop", [-0.35, 0.84, 0.1], 0.6, 190.0),
        at("king", [1.0, 0.98, -0.3], 0.7, -20.0),
    ];
    let camera = Camera::new(DVec3::new(-0.8, 2.0, 6.2), DVec3::new(-0.1, 0.7, 0.2), 36.0);
    Preset::on_board(scene, &[], solids, camera)
}

/// Behind, solids are clipped by a plane; in front of them, the same solids are cut by the same half-space.
fn clipped(scene: &Scene) -> Preset {
    let mut solids = Vec::new();
    for (name, x, height, cut) in [
        ("die", -1.9, 0.58, plane(Vec3::new(-1.0, 2.0, 1.5), 0.0)),
        ("bishop", 0.0, 0.8, plane(Vec3::Z, 0.0)),
        ("shell", 1.9, 0.58, plane(Vec3::new(0.2, 0.5, 1.0), 0.2)),
    ] {
        let open = SolidInstance { clip: Some(cut), ..at(name, [x, height, -1.3], 0.55, -12.0) };
        let mut capped = at(name, [x, height, 1.4], 0.55, -12.0);
        capped.solid = capped.solid.intersection(Solid::Convex(vec![cut], "red"));
        solids.extend([open, capped]);
    }
    let camera = Camera::new(DVec3::new(-1.2, 4.4, 6.8), DVec3::new(0.0, 0.3, 0.1), 33.0);
    Preset::on_board(scene, &[], solids, camera)
}

/// From within a dodecahedron that is clipped open, at the chess set in the fog.
fn inside(scene: &Scene) -> Preset {
    let mut room = at("room", [0.0, 1.6, 8.6], 3.6, 0.0);
    room.clip = Some(plane(Vec3::NEG_Z, 0.55));
    let solids = vec![room];
    let camera = Camera::new(DVec3::new(0.9, 1.6, 11.6), DVec3::new(-0.2, 1.5, 0.0), 66.0);
    let all = ["king", "queen", "rook", "bishop", "knight", "pawn"];
    Preset {
        sun: Sun { azimuth: 238.0, elevation: 24.0, radiance: Vec3::new(5.2, 4.0, 2.7) },
        fog: Fog { distance: 7.0, ..Fog::default() },
        ..Preset::on_board(scene, &all, solids, camera)
    }
}

/// Faces that coincide, solids that touch, and cutters that end with what they cut or only graze it.
fn ties(scene: &Scene) -> Preset {
    let solids = vec![
        at("halves", [-1.9, 0.8, 0.2], 0.48, 20.0),
        at("slotted cube", [-0.55, 0.8, 1.0], 0.48, 100.0),
        at("grazed cube", [0.9, 0.8, 0.3], 0.48, 10.0),
        at("tower", [2.2, 0.84, 0.6], 0.6, 20.0),
    ];
    let camera = Camera::new(DVec3::new(-0.6, 2.6, 6.0), DVec3::new(0.15, 0.72, 0.2), 32.0);
    Preset::on_board(scene, &[], solids, camera)
}

/// A solid in its own space, which is the world's except for its rotation.
fn one_solid(scene: &Scene, modifiers: &Modifiers) -> Preset {
    let solid = shapes::shape(modifiers.shape, modifiers.planes);
    let camera = Camera::new(DVec3::new(2.6, 1.9, 3.4), DVec3::new(0.0, -0.1, 0.0), 37.0);
    let solids = vec![SolidInstance {
        solid,
        transform: Affine3A::from_rotation_y(modifiers.turn.to_radians()),
        clip: None,
    }];
    Preset::of(scene, &[], solids, camera)
}
