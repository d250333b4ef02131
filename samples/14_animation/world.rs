//! The world: its fixed and its moving objects, and the instance of each.

use anyhow::{Context, Result};
use ash::vk;
use common::gpu::{AccelerationStructure, Buffer, Gpu, Sampling, order};
use common::model::{Model, Texture};
use common::scene::{
    InstanceRecord, Material, Scene, SceneAddresses, SceneOnGpu, SceneOptions, input_usage,
    instance_on_gpu, moved_bounds,
};
use glam::{Affine3A, Mat3A, Vec3, Vec3A};

use super::flag;
use super::leg::Motion;
use super::motion::{KINDS, Placed, SIDES};
use super::pole;
use super::turned::{self, TABLE};

/// The position of the flag's pole, and the direction of the wind.
const POLE: Vec3 = Vec3::new(5.7, TABLE, -5.2);
const POLE_HEIGHT: f32 = 6.4;
const WIND: f32 = 2.9;

/// Everything in the world, and its place at a frame.
pub struct World {
    /// The meshes on the device; what moves has a top level of its own.
    pub scene: SceneOnGpu,
    pub motion: Motion,
    /// Addresses of records and materials.
    pub addresses: SceneAddresses,
    standing: Vec<Standing>,
    host: Scene,
    /// The meshes of the kinds of pieces, in their order.
    kinds: Vec<usize>,
    /// The flag's material.
    cloth: usize,
    records: Buffer,
}

/// A mesh that stays where it is.
struct Standing {
    mesh: usize,
    at: Affine3A,
}

/// An instance at a frame: its mesh, none for the flag, and its record.
struct Shown {
    mesh: Option<usize>,
    record: usize,
    at: Affine3A,
}

impl World {
    pub fn new(
        gpu: &Gpu,
        motion: Motion,
        flag: &flag::Flag,
        options: SceneOptions,
    ) -> Result<Self> {
        let mut host = Scene::chess()?;
        host.instances.clear();
        let cloth = furnish(&mut host.model);
        let model = &host.model;
        let standing = [
            ("board_light", Vec3::ZERO),
            ("board_dark", Vec3::ZERO),
            ("board_frame", Vec3::ZERO),
            ("screen", Vec3::new(0.0, 0.02, -4.28)),
            ("screen_frame", Vec3::new(0.0, 0.02, -4.28)),
            ("table", Vec3::new(0.0, TABLE, 0.0)),
            ("pole", POLE),
        ];
        let standing = standing
            .into_iter()
            .map(|(name, at)| {
                Ok(Standing { mesh: mesh(model, name)?, at: Affine3A::from_translation(at) })
            })
            .collect::<Result<Vec<_>>>()?;
        let kinds = KINDS.map(|name| mesh(model, name)).into_iter().collect::<Result<Vec<_>>>()?;
        let [white, black] = SIDES.map(|name| material(model, name));
        let sides = [white?, black?];

        let scene = SceneOnGpu::new(gpu, &host, options)?;
        // A record for each kind of piece of each side, for all fixed objects, and for the flag.
        let pieces = sides.iter().flat_map(|&side| kinds.iter().map(move |&kind| (kind, side)));
        let still = standing.iter().map(|one| (one.mesh, model.meshes[one.mesh].material));
        let record = |(mesh, material): (usize, usize)| InstanceRecord {
            material: material as u32,
            ..scene.meshes[mesh]
        };
        let of_flag = InstanceRecord { material: cloth as u32, ..flag.record };
        let records: Vec<_> = pieces.chain(still).map(record).chain([of_flag]).collect();
        let records = Buffer::with_data(gpu, "instance records", &records, input_usage())?;
        let addresses = SceneAddresses { instances: records.address.into(), ..scene.addresses };
        Ok(Self { scene, motion, addresses, standing, host, kinds, cloth, records })
    }

    /// Takes another flag.
    pub fn take(&mut self, flag: &flag::Flag) -> Result<()> {
        let record = InstanceRecord { material: self.cloth as u32, ..flag.record };
        let before = 2 * self.kinds.len() + self.standing.len();
        self.records.write((before * size_of::<InstanceRecord>()) as u64, &[record])
    }

    /// Everything in a frame: first the fixed objects, then the pieces, then the flag.
    fn shown(&self, frame: u32) -> impl Iterator<Item = Shown> {
        let pieces = 2 * self.kinds.len();
        let still = self.standing.iter().enumerate().map(move |(number, one)| Shown {
            mesh: Some(one.mesh),
            record: pieces + number,
            at: one.at,
        });
        let moving = self.motion.at(frame).map(|Placed { side, kind, at }| Shown {
            mesh: Some(self.kinds[kind]),
            record: side * self.kinds.len() + kind,
            at,
        });
        let top = POLE + (POLE_HEIGHT - 0.25) * Vec3::Y;
        let matrix3 = Mat3A::from_rotation_y(WIND);
        let flag = Shown {
            mesh: None,
            record: pieces + self.standing.len(),
            at: Affine3A { matrix3, translation: Vec3A::from(top) },
        };
        still.chain(moving).chain([flag])
    }

    /// In which order the instances are built: neighbours at this frame beside each other.
    pub fn order(&self, gpu: &Gpu, frame: u32) -> Vec<u32> {
        let bounds = self.shown(frame).map(|shown| {
            let corners = match shown.mesh {
                Some(mesh) => self.host.model.meshes[mesh].bounds(),
                None => flag::bounds(),
            };
            moved_bounds(corners, &shown.at)
        });
        order::for_build(gpu, &bounds.collect::<Vec<_>>(), self.scene.options.ordering)
    }

    /// The instances at a frame, in an order that a build has chosen.
    pub fn instances(
        &self,
        frame: u32,
        order: &[u32],
        flag: &AccelerationStructure,
    ) -> Vec<vk::AccelerationStructureInstanceKHR> {
        let shown: Vec<_> = self.shown(frame).collect();
        let instance = |&index: &u32| {
            let Shown { mesh, record, at } = &shown[index as usize];
            let blas = mesh.map_or(flag, |mesh| &self.scene.blas[mesh]);
            instance_on_gpu(at, *record, 0, blas)
        };
        order.iter().map(instance).collect()
    }
}

/// Adds table, pole and the flag's material to the chess set; returns that.
fn furnish(model: &mut Model) -> usize {
    let felt = Material {
        name: "felt".to_owned(),
        base_color: Vec3::new(0.028, 0.075, 0.068),
        ..Material::default()
    };
    let brass = Material {
        name: "brass".to_owned(),
        base_color: Vec3::new(0.42, 0.29, 0.1),
        specular: Vec3::new(0.3, 0.22, 0.1),
        shininess: 60.0,
        ..Material::default()
    };
    let texture = Some(model.textures.len());
    model.textures.push(checks());
    let cloth = Material {
        name: "cloth".to_owned(),
        base_color: Vec3::ONE,
        specular: Vec3::splat(0.02),
        shininess: 20.0,
        base_texture: texture,
        ..Material::default()
    };
    let first = model.materials.len();
    model.materials.extend([felt, brass, cloth]);
    model.meshes.push(turned::table(9.6, first));
    model.meshes.push(pole::pole(POLE_HEIGHT, first + 1));
    first + 2
}

/// The flag's cloth: checks of two colours, six by four, with a border of one.
fn checks() -> Texture {
    let (width, height) = (384, 256);
    let texel = |(x, y): (u32, u32)| {
        let edge = x.min(y).min(width - 1 - x).min(height - 1 - y) < 12;
        let light = (x / 64 + y / 64) % 2 == 0 && !edge;
        if light { [226, 208, 172, 255] } else { [134, 22, 26, 255] }
    };
    let rgba = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(texel).collect();
    Texture {
        name: "flag".to_owned(),
        width,
        height,
        rgba,
        srgb: true,
        slopes: false,
        sampling: Sampling::default(),
    }
}

fn mesh(model: &Model, name: &str) -> Result<usize> {
    let found = model.meshes.iter().position(|mesh| mesh.name == name);
    found.with_context(|| format!("the chess set has no mesh '{name}'"))
}

fn material(model: &Model, name: &str) -> Result<usize> {
    let found = model.materials.iter().position(|material| material.name == name);
    found.with_context(|| format!("the chess set has no material '{name}'"))
}
