//! A composition: everything in a picture, meshes and other objects.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use common::scene::{Camera, DiskLight, Light, Material, Scene, Sun};
use glam::{Vec2, Vec3};

use crate::rough::roughen;
use crate::{
    Box, Environment, Face, Finish, Motion, Solid, Sphere, Strands, ThinLens, Torus, is_glass,
};

/// A landscape in a box, as high as two waves say: hills, and ridges across.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heightfield {
    /// The lowest x and z.
    pub low: Vec2,
    /// The highest.
    pub high: Vec2,
    /// Height of the hills.
    pub hills: f32,
    /// Length of a hill and its valley along x and along z.
    pub hill: Vec2,
    /// Height of the ridges.
    pub ridges: f32,
    /// Their length along x and along z.
    pub ridge: Vec2,
    /// Colour of the light fields, linear RGB.
    pub light: Vec3,
    /// Colour of the dark ones.
    pub dark: Vec3,
    /// Colour where it is steep.
    pub rock: Vec3,
    /// Length of a field's side.
    pub square: f32,
}

/// A light, and whether objects in its way cast a shadow.
#[derive(Clone, Copy, Debug)]
pub struct SceneLight {
    /// The light, as a disk.
    pub disk: DiskLight,
    /// True if shadow rays are traced to it.
    pub shadows: bool,
}

/// An infinite plane, `normal · p = distance · |normal|`, and the squares on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardPlane {
    /// Points to the outside; any length but 0.
    pub normal: Vec3,
    /// From the origin along the normal.
    pub distance: f32,
    /// Colour of the light squares, linear RGB.
    pub light: Vec3,
    /// Colour of the dark squares.
    pub dark: Vec3,
    /// Length of a square's side.
    pub square: f32,
    /// The part of the light that is mirrored at normal incidence.
    pub reflection: f32,
}

/// Everything that a picture is made from.
#[derive(Clone)]
pub struct Composition {
    /// Meshes in use, materials, instances, the camera.
    pub scene: Scene,
    /// The camera's lens.
    pub lens: ThinLens,
    /// A finish for each material; none for unused ones.
    pub finishes: Vec<Finish>,
    /// At most [`MAX_LIGHTS`].
    pub lights: Vec<SceneLight>,
    /// The plane, if there is one.
    pub plane: Option<BoardPlane>,
    /// Spheres; their materials are opaque.
    pub spheres: Vec<Sphere>,
    /// Boxes, likewise.
    pub boxes: Vec<Box>,
    /// Convex solids, likewise.
    pub solids: Vec<Solid>,
    /// The faces of all solids: first all faces of the first solid, then those of the second, and so on.
    pub faces: Vec<Face>,
    /// Corners of the boxes around the solids.
    pub solid_bounds: Vec<(Vec3, Vec3)>,
    /// Swept spheres, likewise.
    pub strands: Strands,
    /// Tori, likewise.
    pub tori: Vec<Torus>,
    /// The landscape, if there is one.
    pub heightfield: Option<Heightfield>,
    /// True if textures are averaged over a pixel's footprint.
    pub filtered: bool,
    /// Brightness of the sky, 0 to 1.
    pub sky: f32,
    /// The picture that is the sky, if it is one.
    pub environment: Option<Environment>,
    /// Rays a pixel.
    pub samples: u32,
    /// Shadow rays a hit, to a light that has a size.
    pub light_samples: u32,
    /// Maximum number of reflections and refractions of a path.
    pub depth: u32,
    /// Maximum number of times it is scattered.
    pub bounces: u32,
    /// Motion from frame to frame, if there is any.
    pub motion: Option<Motion>,
}

/// The most lights of a composition.
pub const MAX_LIGHTS: usize = 4;
/// Range of distances at which a lens can be in focus.
pub const FOCUS: RangeInclusive<f32> = 0.015625..=1024.0;

impl Composition {
    /// Meshes in place, under the lights of their file, or else under a sun.
    pub fn of_meshes(mut scene: Scene) -> Self {
        let model = &mut scene.model;
        if model.lights.len() > MAX_LIGHTS {
            let count = model.lights.len();
            model.warnings.push(format!("of the {count} lights, the first {MAX_LIGHTS} are shown"));
        }
        let mut lights: Vec<Light> =
            model.lights.iter().take(MAX_LIGHTS).map(|light| (*light).into()).collect();
        if lights.is_empty() {
            lights.push(Light::directional(&Sun::default()));
        }
        let lights = lights.into_iter().map(|light| SceneLight {
            disk: DiskLight { light, radius: 0.0, samples: 1 },
            shadows: true,
        });
        let lights = lights.collect();
        let mut composition = Self {
            finishes: scene.model.materials.iter().map(Finish::of).collect(),
            lens: pinhole(&scene.camera),
            scene,
            lights,
            plane: None,
            spheres: Vec::new(),
            boxes: Vec::new(),
            solids: Vec::new(),
            faces: Vec::new(),
            solid_bounds: Vec::new(),
            strands: Strands::default(),
            tori: Vec::new(),
            heightfield: None,
            filtered: false,
            sky: 1.0,
            environment: None,
            samples: 1,
            light_samples: 16,
            depth: 4,
            bounces: 0,
            motion: None,
        };
        composition.scene.model.materials.iter_mut().for_each(close);
        composition.prune();
        composition
    }

    /// The used materials, each once, in the model's order.
    pub fn materials_in_use(&self) -> impl Iterator<Item = &Material> {
        self.in_use().into_iter().map(|index| &self.scene.model.materials[index])
    }

    /// Their numbers.
    pub(crate) fn in_use(&self) -> BTreeSet<usize> {
        let meshes = self.scene.instances.iter().map(|instance| instance.material);
        let spheres = self.spheres.iter().map(|sphere| sphere.material as usize);
        let boxes = self.boxes.iter().map(|b| b.material as usize);
        let solids = self.solids.iter().map(|solid| solid.material as usize);
        let strands = self.strands.segments.iter().map(|segment| segment.material as usize);
        let tori = self.tori.iter().map(|torus| torus.material as usize);
        meshes.chain(spheres).chain(boxes).chain(solids).chain(strands).chain(tori).collect()
    }

    /// Number of spheres that move while the shutter is open.
    pub fn moving(&self) -> usize {
        self.spheres.iter().filter(|sphere| sphere.moves != Vec3::ZERO).count()
    }

    /// Returns whether a material may become glass: no strand and no moving object uses it.
    pub fn may_be_glass(&self, material: u32) -> bool {
        let moves = |sphere: &Sphere| sphere.material == material && sphere.moves != Vec3::ZERO;
        !self.strands.segments.iter().any(|segment| segment.material == material)
            && !self.spheres.iter().any(moves)
    }

    /// The finishes, if any material in use has one; shaders read no others.
    pub fn finishes_to_read(&self) -> &[Finish] {
        let plain = self.finishes.iter().all(|finish| *finish == Finish::NONE);
        if plain { &[] } else { &self.finishes }
    }

    /// Drops the meshes that nothing places and the textures that no material in use reads, so that no
    /// memory is spent on them. Materials stay: they are few, and others count on their numbers.
    pub fn prune(&mut self) {
        let used = self.in_use();
        let Scene { model, instances, .. } = &mut self.scene;
        let meshes: BTreeSet<usize> = instances.iter().map(|instance| instance.mesh).collect();
        let numbers = keep(&mut model.meshes, &meshes);
        for instance in instances {
            instance.mesh = numbers[&instance.mesh];
        }
        for (number, material) in model.materials.iter_mut().enumerate() {
            if !used.contains(&number) {
                material.textures().for_each(|slot| *slot = None);
                self.finishes[number] = Finish::NONE;
            }
        }
        let slots = model.materials.iter_mut().flat_map(Material::textures);
        let textures: BTreeSet<usize> = slots.filter_map(|slot| *slot).collect();
        let numbers = keep(&mut model.textures, &textures);
        for material in &mut model.materials {
            for slot in material.textures() {
                *slot = slot.map(|old| numbers[&old]);
            }
        }
    }
}

/// Glass has no holes: what comes through it is not what its opacity leaves. Nor has it microfacets.
pub(crate) fn close(material: &mut Material) {
    if is_glass(material) {
        (material.opacity, material.opacity_texture, material.microfacet) = (1.0, None, None);
    }
    roughen(material);
}

/// A hole, through which everything is sharp; as a lens it is focused on the camera's target, as far as one can be.
pub(crate) fn pinhole(camera: &Camera) -> ThinLens {
    let focus = (camera.eye.distance(camera.target) as f32).clamp(*FOCUS.start(), *FOCUS.end());
    ThinLens { diameter: 0.0, focus, blades: 0, rotation: 0.0 }
}

/// Keeps the items at these positions, and says where each is then.
fn keep<T>(items: &mut Vec<T>, positions: &BTreeSet<usize>) -> BTreeMap<usize, usize> {
    let mut position = 0..;
    items.retain(|_| position.next().is_some_and(|at| positions.contains(&at)));
    positions.iter().copied().zip(0..).collect()
}
