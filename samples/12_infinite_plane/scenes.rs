//! The scenes of this chapter: the objects on the plane, above it and in it.

use anyhow::Result;
use common::model::Model;
use common::scene::board::Board;
use common::scene::plane::HalfSpace;
use common::scene::{Camera, Instance, Material, Mesh, PointLight, Scene, Sun, Vertex};
use glam::{Affine3A, DVec3, Mat3A, Vec2, Vec3, Vec3Swizzles};

common::shader_enum! {
    /// The names of the presets.
    pub enum PresetName { Board, FourSpheres, Pov }
    /// The lights that shine.
    pub enum Lights { Directional, Point, Both }
}

/// A scene with its lights, its camera, and the plane beside it.
pub struct Preset {
    /// The placed meshes, and the view.
    pub scene: Scene,
    /// The sun.
    pub sun: Sun,
    /// The lamp.
    pub lamp: PointLight,
    /// The lights that shine.
    pub lights: Lights,
    /// The plane is the surface of this.
    pub plane: HalfSpace,
    /// The board on it.
    pub board: Board,
}

/// A glossy paint of the preset *four spheres*: name, colour, specular, reflection.
struct Paint(&'static str, Vec3, f32, f32);

const PAINTS: [Paint; 2] = [
    Paint("red ball", Vec3::new(0.85, 0.06, 0.045), 1.0, 0.7),
    Paint("blue ball", Vec3::new(0.16, 0.36, 0.9), 1.0, 0.9),
];

/// Its balls: middle, radius, paint.
const FOUR_SPHERES: [(Vec3, f32, &str); 4] = [
    (Vec3::new(-5.0, -8.0, 15.0), 4.0, "red ball"),
    (Vec3::new(5.0, -8.0, 15.0), 4.0, "red ball"),
    (Vec3::new(0.0, -8.0, 7.0), 4.0, "red ball"),
    (Vec3::new(0.0, 9.0, 16.0), 7.0, "blue ball"),
];

/// The chess set of metal, from so low down that the horizon is seen.
pub fn chess() -> Result<Scene> {
    let camera = Camera::new(DVec3::new(-3.4, 1.6, 7.2), DVec3::new(0.6, 0.62, 0.0), 37.0);
    Ok(Scene { camera, ..Scene::chess_of_metal()? })
}

/// Adds what the presets are made of to a model.
pub fn extend(model: &mut Model) {
    let mesh = ball(model.materials.len());
    model.meshes.push(mesh);
    for Paint(name, base_color, specular, _) in &PAINTS {
        model.materials.push(Material {
            name: (*name).to_owned(),
            base_color: *base_color,
            specular: Vec3::splat(*specular),
            shininess: 200.0,
            illumination: 3,
            ..Material::default()
        });
    }
}

/// The part of the light that a material mirrors at normal incidence. In an MTL file that is the
/// specular colour, if the illumination model reflects (`illum 3`); the balls have a list of their
/// own, and their mirror images have their colour.
pub fn reflection(material: &Material) -> Vec3 {
    match PAINTS.iter().find(|paint| paint.0 == material.name) {
        Some(Paint(_, color, _, reflection)) => color / color.max_element() * reflection,
        None if material.illumination >= 3 => material.specular,
        None => Vec3::ZERO,
    }
}

impl Preset {
    /// The preset of a name. `scene` is placed on the board; the others use meshes of its model.
    pub fn new(name: PresetName, scene: &Scene) -> Self {
        match name {
            PresetName::Board => board(scene),
            PresetName::FourSpheres => four_spheres(scene),
            PresetName::Pov => pov(scene),
        }
    }
}

/// The scene on an infinite board. The plane y = 0 takes the place of the squares and the frame, and shows the
/// horizon.
fn board(scene: &Scene) -> Preset {
    let mut scene = scene.clone();
    scene.remove_board();
    Preset {
        scene,
        sun: Sun { azimuth: 285.0, elevation: 17.0, radiance: Vec3::new(5.2, 4.0, 2.7) },
        lamp: PointLight::default(),
        lights: Lights::Directional,
        plane: HalfSpace::new(Vec3::Y, 0.0),
        board: Board {
            light: Vec3::new(0.62, 0.46, 0.26),
            dark: Vec3::new(0.115, 0.048, 0.022),
            specular: 0.03,
            roughness: 0.38,
            reflection: 0.03,
            ..Board::default()
        },
    }
}

/// Four balls above a green plane, which they mirror and which mirrors them.
fn four_spheres(scene: &Scene) -> Preset {
    let model = scene.model.clone();
    let balls = FOUR_SPHERES.map(|(middle, radius, paint)| place(&model, middle, radius, paint));
    // The window is 20 by 20 at a distance of 10: 90 degrees.
    let camera = Camera::new(DVec3::new(0.0, 0.0, -10.0), DVec3::ZERO, 90.0);
    Preset {
        scene: Scene { model, instances: balls.into(), camera },
        // Along (0, -1, 0.1).
        sun: Sun { azimuth: 180.0, elevation: 84.28941, radiance: Vec3::splat(1.3) },
        lamp: PointLight { position: Vec3::new(1.0, 20.0, -10.0), intensity: Vec3::splat(1500.0) },
        lights: Lights::Both,
        plane: HalfSpace::new(Vec3::Y, -14.0),
        board: Board {
            light: Vec3::new(0.05, 0.45, 0.07),
            dark: Vec3::new(0.05, 0.45, 0.07),
            specular: 0.5,
            roughness: 0.42,
            reflection: 0.1,
            checker: 0,
            square: 4.0,
            ..Board::default()
        },
    }
}

/// Balls half sunk into a tilted plane, whose normal is not a unit vector.
fn pov(scene: &Scene) -> Preset {
    let model = scene.model.clone();
    let plane = HalfSpace::new(Vec3::new(-1.0, 3.0, 1.0), 1.0);
    let ring = (0..7).map(|i| {
        let angle = i as f32 * std::f32::consts::TAU / 7.0;
        let radius = 0.55 + 0.1 * (i % 3) as f32;
        let (x, z) = (2.3 * angle.cos(), 2.3 * angle.sin());
        // On the plane, and a little to either side of it.
        let y = (plane.distance * plane.normal.length() + x - z) / 3.0;
        let aside = 0.35 * ((i * 3 % 7) as f32 / 3.0 - 1.0);
        place(&model, Vec3::new(x, y + aside, z), radius, ["red ball", "blue ball", "gold"][i % 3])
    });
    let instances = ring.collect();
    let camera = Camera::new(DVec3::new(6.3, 2.9, 6.1), DVec3::new(0.0, 0.5, 0.0), 38.0);
    Preset {
        scene: Scene { model, instances, camera },
        sun: Sun { azimuth: 300.0, elevation: 40.0, radiance: Vec3::new(4.0, 3.4, 2.7) },
        lamp: PointLight::default(),
        lights: Lights::Directional,
        plane,
        board: Board {
            light: Vec3::new(0.6, 0.56, 0.48),
            dark: Vec3::new(0.1, 0.16, 0.17),
            specular: 0.04,
            roughness: 0.36,
            reflection: 0.04,
            ..Board::default()
        },
    }
}

fn place(model: &Model, middle: Vec3, radius: f32, material: &str) -> Instance {
    let by_name = |name: &str| model.materials.iter().position(|material| material.name == name);
    Instance {
        mesh: model.meshes.len() - 1,
        transform: Affine3A {
            matrix3: Mat3A::from_diagonal(Vec3::splat(radius)),
            translation: middle.into(),
        },
        record_offset: 0,
        // Another model's materials may lack the gold of the chess set.
        material: by_name(material).unwrap_or(model.materials.len() - 1),
    }
}

/// The unit sphere from the six faces of a cube, whose triangles have no poles to crowd at.
fn ball(material: usize) -> Mesh {
    const STEPS: u32 = 56;
    let mut mesh = Mesh { name: "ball".to_owned(), vertices: vec![], triangles: vec![], material };
    for (out, across) in
        [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|x| [(x, x.zxy()), (-x, x.zxy())])
    {
        let first = mesh.vertices.len() as u32;
        let up = out.cross(across);
        for i in 0..=STEPS {
            for j in 0..=STEPS {
                // Equal angles make the triangles more equal than equal lengths.
                let [x, y] = [i, j].map(|k| {
                    let part = k as f32 / STEPS as f32 - 0.5;
                    (part * std::f32::consts::FRAC_PI_2).tan()
                });
                let position = (out + x * across + y * up).normalize();
                mesh.vertices.push(Vertex { position, normal: position, uv: Vec2::ZERO });
            }
        }
        for corner in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| first + i * (STEPS + 1) + j))
        {
            let [a, b, c, d] = [corner, corner + STEPS + 1, corner + STEPS + 2, corner + 1];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}
