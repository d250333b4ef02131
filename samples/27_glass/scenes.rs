//! The scenes of this chapter: two to look at, and those whose rays are known in closed form.

use anyhow::{Context, Result};
use common::model::Model;
use common::scene::{Camera, Instance, Material, Mesh, PointLight, Scene};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};

use super::bodies::{ball, bar, regular, turned};

common::shader_enum! {
    /// The names of the scenes.
    pub enum SceneName {
        /// A game in glass and gold.
        Chess,
        /// A drink, modelled into the wall of its glass, with a pawn in it.
        Drink,
        /// The same, a hair away from the wall.
        DrinkApart,
        /// The same, with one surface for both.
        DrinkFlush,
        /// A king and a ball of clear glass, in nothing.
        Furnace,
        /// A slab, a unit thick.
        Slab,
        /// A ball of radius 1.
        Ball,
        /// A prism with three equal sides.
        Prism,
        /// A sheet without an inside.
        Pane,
    }
    /// The light of a ray that hits nothing.
    pub enum Sky: SKY { Evening, Day, White }
}

/// A scene with its camera and its lights.
pub struct Staged {
    /// The placed meshes, and the view.
    pub scene: Scene,
    /// The lamp.
    pub lamp: PointLight,
    /// The sky.
    pub sky: Sky,
}

/// Tilt of the pane, in radians.
const PANE: f32 = 1.2;

/// Height of a piece above the board: glass on wood has air below it.
const GAP: f32 = 1e-3;

/// The chess set: white men of glass, black ones of ruby glass, kings and queens of gold.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess_of_metal()?;
    let Model { meshes, materials, .. } = &mut scene.model;
    let named = |name: &str| materials.iter().position(|material| material.name == name);
    let gold = named("gold").context("the chess set has no gold")?;
    for instance in &mut scene.instances {
        if materials[instance.material].name == "silver" {
            instance.material = gold;
        }
        let stands = ["pawn", "rook", "knight", "bishop", "queen", "king"];
        if stands.contains(&meshes[instance.mesh].name.as_str()) {
            instance.transform.translation.y += GAP;
        }
    }
    for material in materials {
        match material.name.as_str() {
            "white" => *material = glass("white", 1.5, Vec3::new(0.93, 0.97, 0.96)),
            "black" => *material = glass("black", 1.5, Vec3::new(0.55, 0.02, 0.03)),
            _ => {}
        }
    }
    scene.camera = Camera::new(DVec3::new(5.3, 2.7, -4.4), DVec3::new(0.1, 0.35, -0.55), 31.0);
    Ok(scene)
}

/// A body of glass; `through` is left after a unit of length.
fn glass(name: &str, refraction: f32, through: Vec3) -> Material {
    Material {
        name: name.to_owned(),
        illumination: 7,
        refraction,
        transmission: through,
        ..Material::default()
    }
}

impl Staged {
    /// The scene of a name; `source` is the chess set.
    pub fn new(name: SceneName, source: &Scene) -> Self {
        let lamp = PointLight {
            position: Vec3::new(-4.5, 4.5, 3.0),
            intensity: Vec3::new(110.0, 80.0, 46.0),
        };
        let shown = |scene| Self { scene, lamp, sky: Sky::Evening };
        // No light but the sky.
        let plain =
            |scene, sky| Self { scene, lamp: PointLight { intensity: Vec3::ZERO, ..lamp }, sky };
        let clear = glass("clear", 1.5, Vec3::ONE);
        match name {
            SceneName::Chess => shown(source.clone()),
            SceneName::Drink => shown(drink(source, 0.5 * WALL)),
            SceneName::DrinkApart => shown(drink(source, -4.0 * GAP)),
            SceneName::DrinkFlush => shown(drink(source, 0.0)),
            SceneName::Furnace => plain(furnace(source), Sky::White),
            SceneName::Slab => {
                let turn = Quat::from_rotation_y(0.5);
                let size = Vec3::new(20.0, 20.0, 1.0);
                let place = Affine3A::from_scale_rotation_translation(size, turn, Vec3::ZERO);
                plain(alone(bar("slab", &regular(4)), clear, place, 5.0, 40.0), Sky::Day)
            }
            SceneName::Ball => {
                let place = Affine3A::IDENTITY;
                plain(alone(ball("ball", 512), clear, place, 1000.0, 0.02), Sky::Day)
            }
            SceneName::Prism => {
                let place = Affine3A::from_rotation_x(std::f32::consts::FRAC_PI_2);
                let mut scene = alone(bar("prism", &regular(3)), clear, place, 5.0, 20.0);
                scene.camera =
                    Camera::new(DVec3::new(4.99, 0.0, -1.45), DVec3::new(0.25, 0.0, 0.144), 5.0);
                plain(scene, Sky::Day)
            }
            SceneName::Pane => {
                let pane = Material { illumination: 4, ..clear };
                // It leans away, and mirrors the sky above the camera.
                plain(alone(sheet(), pane, Affine3A::from_rotation_x(-PANE), 5.0, 40.0), Sky::Day)
            }
        }
    }
}

/// One body, seen along -z from so far away.
fn alone(mesh: Mesh, material: Material, transform: Affine3A, distance: f64, view: f64) -> Scene {
    let instance = Instance { mesh: 0, transform, material: 0, record_offset: 0 };
    let camera = Camera::new(DVec3::new(0.0, 0.0, distance), DVec3::ZERO, view);
    let model = Model { meshes: vec![mesh], materials: vec![material], ..Model::default() };
    Scene { model, instances: vec![instance], camera }
}

/// A square of side 10, across z.
fn sheet() -> Mesh {
    let section = [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)].map(Vec2::from);
    let mut sheet = bar("pane", &section);
    sheet.vertices.truncate(4);
    sheet.triangles.truncate(2);
    sheet
}

/// A king of clear glass before a ball of it.
fn furnace(source: &Scene) -> Scene {
    let king = source.model.meshes.iter().find(|mesh| mesh.name == "king");
    let place = Affine3A::from_translation(Vec3::new(0.0, -0.8, 0.0));
    let clear = glass("clear", 1.5, Vec3::ONE);
    let mut scene =
        alone(ball("ball", 64), clear, Affine3A::from_translation(Vec3::NEG_Z), 5.0, 26.0);
    scene.model.meshes.extend(king.cloned());
    let king = Instance { mesh: 1, transform: place, material: 0, record_offset: 0 };
    scene.instances.extend((scene.model.meshes.len() > 1).then_some(king));
    scene
}

/// Thickness of the glass around the drink.
const WALL: f32 = 0.07;

/// A drink in a glass on the chess board; `into` is how far it reaches into the wall.
///
/// The glass is the first material, so it counts where both are.
fn drink(source: &Scene, into: f32) -> Scene {
    let inner = |height: f32| 0.50 + 0.08 * height;
    let (bottom, top, level) = (0.16, 1.5, 1.1);
    let mut profile = vec![Vec2::ZERO, Vec2::new(inner(0.0) + WALL, 0.0)];
    // The rim is round.
    let rim = Vec2::new(inner(top) + 0.5 * WALL, top);
    profile.extend((0..=8).map(|i| {
        let angle = std::f32::consts::PI * i as f32 / 8.0;
        rim + 0.5 * WALL * Vec2::new(angle.cos(), angle.sin())
    }));
    profile.extend([Vec2::new(inner(bottom), bottom), Vec2::new(0.0, bottom)]);
    let low = bottom - into;
    let drink = [
        Vec2::new(0.0, low),
        Vec2::new(inner(low) + into, low),
        Vec2::new(inner(level) + into, level),
        Vec2::new(0.0, level),
    ];

    let mut scene = source.clone();
    let is_board =
        |instance: &Instance| source.model.meshes[instance.mesh].name.starts_with("board");
    scene.instances.retain(is_board);
    let pawn = source.model.meshes.iter().position(|mesh| mesh.name == "pawn").unwrap_or(0);
    let gold = source.model.materials.iter().position(|material| material.name == "gold");
    let model = &mut scene.model;
    let first = model.materials.len();
    model.materials.extend([
        glass("tumbler", 1.5, Vec3::new(0.9, 0.96, 0.94)),
        glass("drink", 1.33, Vec3::new(0.75, 0.33, 0.06)),
    ]);
    let stand = Vec3::new(0.5, GAP, 0.5);
    for (mesh, material) in
        [(turned("tumbler", &profile, 128), first), (turned("drink", &drink, 128), first + 1)]
    {
        let transform = Affine3A::from_translation(stand);
        scene.instances.push(Instance {
            mesh: model.meshes.len(),
            transform,
            material,
            record_offset: 0,
        });
        model.meshes.push(mesh);
    }
    let lies = Affine3A::from_scale_rotation_translation(
        Vec3::splat(0.75),
        Quat::from_rotation_y(0.7) * Quat::from_rotation_z(1.1),
        stand + Vec3::new(0.32, bottom + 0.25, -0.1),
    );
    let material = gold.unwrap_or(first);
    scene.instances.push(Instance { mesh: pawn, transform: lies, material, record_offset: 0 });
    scene.camera = Camera::new(DVec3::new(4.6, 2.7, -3.4), DVec3::new(0.45, 0.68, 0.45), 24.0);
    scene
}
