//! The scenes of this chapter: one to look at, two that must be white, and those whose light is known.

use anyhow::{Context, Result};
use common::model::Model;
use common::scene::{Camera, Instance, Material, Scene};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};

use super::closed_forms::{self, square};
use super::emitters::Sphere;

common::shader_enum! {
    /// The names of the scenes.
    pub enum SceneName {
        /// A game by night, between lamps.
        Chess,
        /// The same in white that swallows nothing, in a ball that shines.
        Furnace,
        /// A room whose surfaces all shine and reflect alike.
        ClosedRoom,
        /// A ball that shines above a square.
        Ball,
        /// One beside a square, half of it below the square's plane.
        LowBall,
        /// 64 small balls of very different power.
        ManyBalls,
        /// The game without its polish and its lamps, below strings of a thousand small ones.
        ManyLamps,
        /// A square that shines, a unit away from one that does not.
        ParallelSquares,
        /// A square that shines at a right angle to one that does not.
        PerpendicularSquares,
    }
    /// The light of a ray that hits nothing.
    pub enum Sky: SKY { Night, Day, Black }
}

/// A scene with its camera.
#[derive(Clone)]
pub struct Staged {
    /// The meshes, and the view.
    pub scene: Scene,
    /// The spheres.
    pub spheres: Vec<Sphere>,
    /// The sky.
    pub sky: Sky,
}

/// Gold, silver, ivory, red and blue stone by night, among lamps, embers on the board and screens of paper.
pub fn chess() -> Result<Staged> {
    let mut scene = Scene::chess_of_metal()?;
    let Model { meshes, materials, .. } = &mut scene.model;
    let named = |name: &str| {
        let found = materials.iter().position(|material| material.name == name);
        found.with_context(|| format!("the chess set has no material '{name}'"))
    };
    let [white, red, gold, wood] = ["white", "black", "gold", "frame"].map(named);
    let (white, red, gold, wood) = (white?, red?, gold?, wood?);
    // The fretwork makes way for the screens, which shine.
    scene.instances.retain(|instance| !meshes[instance.mesh].name.starts_with("screen"));
    for instance in &mut scene.instances {
        let is_pawn = meshes[instance.mesh].name == "pawn";
        if instance.material == white && !is_pawn {
            instance.material = gold;
        } else if instance.material == red && is_pawn {
            instance.material = materials.len();
        }
    }
    let blue = Vec3::new(0.02, 0.06, 0.34);
    materials.push(Material { base_color: blue, ..materials[red].clone() });
    materials[red].base_color = Vec3::new(0.5, 0.035, 0.02);
    let first = materials.len();
    materials.push(lamp("lamp", Vec3::new(5.4, 2.2, 0.62)));
    materials.push(lamp("ember", Vec3::new(11.0, 3.2, 0.6)));
    materials.push(lamp("paper", Vec3::new(0.62, 0.43, 0.24)));
    let mesh = meshes.len();
    meshes.push(square("paper", first + 2, Vec3::ZERO, Vec3::X, Vec3::Y));
    // Behind the pieces; and behind the camera, where metal shows it.
    for (middle, size) in [([5.6, 1.75, -2.3], [11.0, 3.3]), ([-9.0, 1.8, 3.8], [10.0, 5.0])] {
        let place =
            Affine3A::from_rotation_translation(Quat::from_rotation_y(-1.18), middle.into());
        for (size, at, is_bar) in screen(size.into()) {
            let own = Affine3A::from_scale_rotation_translation(size, Quat::IDENTITY, at);
            let material = if is_bar { wood } else { first + 2 };
            scene.instances.push(Instance {
                mesh,
                transform: place * own,
                material,
                record_offset: 0,
            });
        }
    }
    let ball = |x, y, z, radius, material| Sphere { center: Vec3::new(x, y, z), radius, material };
    let spheres = vec![
        ball(-3.0, 4.4, -4.0, 1.1, first),
        ball(-1.0, 4.6, 5.6, 1.0, first),
        ball(-3.2, 0.12, 0.5, 0.12, first + 1),
        ball(-1.9, 0.09, -0.3, 0.09, first + 1),
        ball(-0.6, 0.1, -0.6, 0.1, first + 1),
        ball(-0.5, 0.1, 1.4, 0.1, first + 1),
        ball(-3.4, 0.08, -1.2, 0.08, first + 1),
    ];
    scene.camera = Camera::new(DVec3::new(-6.3, 1.95, 2.5), DVec3::new(-0.9, 0.6, -0.1), 32.0);
    Ok(Staged { scene, spheres, sky: Sky::Night })
}

/// The squares of a screen: size and middle of each, and whether it is a bar or the paper between the bars.
fn screen(size: Vec2) -> impl Iterator<Item = (Vec3, Vec3, bool)> {
    let bars = [-1.0, 1.0].into_iter().flat_map(move |side| {
        let upright = (0..=10).map(move |i| {
            let at = Vec3::new(size.x * (0.1 * i as f32 - 0.5), 0.0, 0.05 * side);
            (Vec3::new(0.08, size.y + 0.08, 1.0), at, true)
        });
        let level = (0..=3).map(move |i| {
            let at = Vec3::new(0.0, size.y * (i as f32 / 3.0 - 0.5), 0.06 * side);
            (Vec3::new(size.x + 0.08, 0.08, 1.0), at, true)
        });
        upright.chain(level)
    });
    std::iter::once((size.extend(1.0), Vec3::ZERO, false)).chain(bars)
}

/// A material that shines and reflects nothing.
fn lamp(name: &str, emission: Vec3) -> Material {
    Material { name: name.to_owned(), base_color: Vec3::ZERO, emission, ..Material::default() }
}

impl Staged {
    /// A scene from a file: what shines in it is all the light, or else it is day.
    pub fn from_file(scene: Scene) -> Self {
        let shines = |instance: &Instance| {
            scene.model.materials[instance.material].emission.max_element() > 0.0
        };
        let sky = if scene.instances.iter().any(shines) { Sky::Night } else { Sky::Day };
        Self { scene, spheres: vec![], sky }
    }

    /// The scene of a name; `source` is what those of chess are made from.
    pub fn new(name: SceneName, source: &Self) -> Self {
        let (scene, spheres) = match name {
            SceneName::Chess => return source.clone(),
            SceneName::Furnace => furnace(source),
            SceneName::ClosedRoom => (closed_forms::room(), vec![]),
            SceneName::Ball => above_square(&[(Vec3::new(0.2, 0.1, 1.25), 0.4, 1.0)]),
            SceneName::LowBall => above_square(&[(Vec3::new(0.9, 0.1, 0.1), 0.3, 1.0)]),
            SceneName::ManyBalls => above_square(&many()),
            SceneName::ManyLamps => many_lamps(source),
            SceneName::ParallelSquares => (closed_forms::parallel_squares(), vec![]),
            SceneName::PerpendicularSquares => (closed_forms::perpendicular_squares(), vec![]),
        };
        let sky = if name == SceneName::ManyLamps { Sky::Night } else { Sky::Black };
        Self { scene, spheres, sky }
    }

    /// Corners of the box around everything.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.spheres.iter().fold(self.scene.bounds(), |(low, high), sphere| {
            (low.min(sphere.center - sphere.radius), high.max(sphere.center + sphere.radius))
        })
    }
}

/// A scene in white that scatters all light, in a ball that shines with 1: there is nothing to be seen.
fn furnace(source: &Staged) -> (Scene, Vec<Sphere>) {
    let mut scene = source.scene.clone();
    for material in &mut scene.model.materials {
        let name = material.name.clone();
        *material = Material { name, base_color: Vec3::ONE, ..Material::default() };
    }
    let (low, high) = scene.bounds();
    let eye = scene.camera.eye.as_vec3();
    let center = 0.5 * (low + high);
    let radius = 1.5 * (high - low).length().max((eye - center).length());
    scene.model.materials.push(lamp("sky", Vec3::ONE));
    let material = scene.model.materials.len() - 1;
    (scene, vec![Sphere { center, radius, material }])
}

/// The set in matte, 81 dim lamps at the corners of the squares, and strings of 943 bright ones above the board.
fn many_lamps(source: &Staged) -> (Scene, Vec<Sphere>) {
    let mut scene = source.scene.clone();
    let meshes = &scene.model.meshes;
    scene.instances.retain(|instance| meshes[instance.mesh].name != "paper");
    for material in &mut scene.model.materials {
        // Metals have no other colour than that of their reflections.
        material.base_color = material.base_color.max(0.7 * material.specular);
        (material.specular, material.emission, material.illumination) = (Vec3::ZERO, Vec3::ZERO, 1);
    }
    let first = scene.model.materials.len();
    let colors = [[1.0, 0.5, 0.16], [1.0, 0.72, 0.4], [1.0, 0.3, 0.1], [0.45, 0.6, 1.0]];
    for (strength, name) in [(16.0, "corner"), (30.0, "bulb")] {
        let lamps = colors.map(|color| lamp(name, strength * Vec3::from(color)));
        scene.model.materials.extend(lamps);
    }
    let corners = (0..81).map(|i: usize| Sphere {
        center: Vec3::new((i % 9) as f32 - 4.0, 0.05, (i / 9) as f32 - 4.0),
        radius: 0.035,
        material: first + [0, 1, 2][i * 7 % 3],
    });
    let bulbs = (0..943).map(|i: usize| {
        let (along, across) = ((i % 41) as f32 / 20.0 - 1.0, (i / 41) as f32 / 11.0 - 1.0);
        let height = 2.1 + 1.3 * along * along + 0.3 * across * across;
        Sphere {
            center: Vec3::new(5.5 * along, height, 5.2 * across),
            radius: 0.022,
            material: first + 4 + [0, 1, 2, 3, 1][i * 13 % 5],
        }
    });
    scene.camera = Camera::new(DVec3::new(-7.4, 2.6, 3.6), DVec3::new(-0.6, 0.5, 0.1), 36.0);
    let spheres = corners.chain(bulbs).collect();
    (scene, spheres)
}

/// The white square alone, and balls that shine: centre, radius and radiance.
fn above_square(balls: &[(Vec3, f32, f32)]) -> (Scene, Vec<Sphere>) {
    let mut scene = closed_forms::white_square(0.75);
    scene.model.materials.extend(balls.iter().map(|ball| lamp("ball", Vec3::splat(ball.2))));
    let place = |(i, &(center, radius, _)): (usize, &(Vec3, f32, f32))| Sphere {
        center,
        radius,
        material: i + 1,
    };
    (scene, balls.iter().enumerate().map(place).collect())
}

/// 64 balls in a plane, none of which hides another from the square. The brightest has 55,000 times the
/// radiance of the faintest.
pub fn many() -> Vec<(Vec3, f32, f32)> {
    let ball = |i: u8| {
        let at = |k: u8| (f32::from(k) - 3.5) * 0.14;
        // 37 has no factor in common with 64, so strong ones are everywhere.
        let radiance = 4000.0 * (-f32::from(i.wrapping_mul(37) % 64) / 4.0).exp2();
        (Vec3::new(at(i % 8), at(i / 8), 1.0), 0.01, radiance)
    };
    (0..64).map(ball).collect()
}
