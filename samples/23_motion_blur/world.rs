//! The world: its fixed and its moving objects, and the place of each while the shutter is open.

use anyhow::{Context, Result};
use common::gpu::{Buffer, Gpu, order};
use common::model::Model;
use common::scene::{
    InstanceRecord, Material, Scene, SceneAddresses, SceneOnGpu, SceneOptions, input_usage,
    moved_bounds, triangle_order,
};
use glam::{Affine3A, Vec3};

use super::ball;
use super::leg::Motion;
use super::motion::{KINDS, Placed, SIDES};
use super::shutter::Pose;
use super::turned::{self, TABLE};

/// The radius of a ball.
pub const BALL: f32 = 0.5;

/// Everything in the world, and its place at a time.
pub struct World {
    /// The meshes on the device; what moves has a top level of its own.
    pub scene: SceneOnGpu,
    pub motion: Motion,
    /// Addresses of records and materials.
    pub addresses: SceneAddresses,
    /// The meshes of the kinds of pieces, in their order.
    pub kinds: Vec<usize>,
    standing: Vec<Standing>,
    host: Scene,
    /// Number of triangles that each mesh is built from.
    primitives: Vec<u32>,
    _records: Buffer,
}

/// A mesh that stays where it is.
struct Standing {
    mesh: usize,
    at: Affine3A,
}

/// An object seen while the shutter is open.
pub struct Shown {
    pub mesh: usize,
    pub record: usize,
    /// Transform when the shutter opens.
    pub at: Affine3A,
    /// Its poses when the shutter opens and when it closes, if these differ.
    pub moved: Option<[Pose; 2]>,
}

impl World {
    pub fn new(gpu: &Gpu, motion: Motion, options: SceneOptions) -> Result<Self> {
        let mut host = Scene::chess()?;
        host.instances.clear();
        furnish(&mut host.model);
        let model = &host.model;
        let standing = [
            ("board_light", Vec3::ZERO),
            ("board_dark", Vec3::ZERO),
            ("board_frame", Vec3::ZERO),
            ("screen", Vec3::new(0.0, 0.02, -4.28)),
            ("screen_frame", Vec3::new(0.0, 0.02, -4.28)),
            ("table", Vec3::new(0.0, TABLE, 0.0)),
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
        // A record for each kind of piece of each side, and for all fixed objects.
        let pieces = sides.iter().flat_map(|&side| kinds.iter().map(move |&kind| (kind, side)));
        let still = standing.iter().map(|one| (one.mesh, model.meshes[one.mesh].material));
        let record = |(mesh, material): (usize, usize)| InstanceRecord {
            material: material as u32,
            ..scene.meshes[mesh]
        };
        let records: Vec<_> = pieces.chain(still).map(record).collect();
        let primitives = |mesh| triangle_order(gpu, mesh, options).len() as u32;
        let primitives = host.model.meshes.iter().map(primitives).collect();
        let records = Buffer::with_data(gpu, "instance records", &records, input_usage())?;
        let addresses = SceneAddresses { instances: records.address.into(), ..scene.addresses };
        Ok(Self { scene, motion, addresses, kinds, standing, host, primitives, _records: records })
    }

    /// Everything while the shutter is open, for so many frames from this one on: first what stands, then the pieces.
    pub fn shown(&self, frame: u32, shutter: f32, turns: u32) -> Vec<Shown> {
        let pieces = 2 * self.kinds.len();
        let still = self.standing.iter().enumerate().map(|(number, one)| Shown {
            mesh: one.mesh,
            record: pieces + number,
            at: one.at,
            moved: None,
        });
        let open = f64::from(frame);
        let ends = [open, open + f64::from(shutter)].map(|time| self.motion.at(time, turns));
        let [opens, closes] = ends;
        let moving = opens.zip(closes).map(|(open, close)| {
            let Placed { side, kind, .. } = open;
            let poses = [open.pose(), close.pose().near(open.pose())];
            Shown {
                mesh: self.kinds[kind],
                record: side * self.kinds.len() + kind,
                at: open.at(),
                moved: (poses[0] != poses[1]).then_some(poses),
            }
        });
        still.chain(moving).collect()
    }

    /// Number of instances.
    pub fn count(&self) -> usize {
        self.standing.len() + self.motion.pieces.len()
    }

    /// The most triangles that a piece has.
    pub fn most_triangles(&self) -> u32 {
        let counts = self.kinds.iter().map(|&mesh| self.triangles(mesh));
        counts.max().unwrap_or(0)
    }

    /// Number of triangles that a mesh is built from: its own, in order, some of them perhaps twice.
    pub fn triangles(&self, mesh: usize) -> u32 {
        self.primitives[mesh]
    }

    /// The box around a mesh in its place.
    pub fn around(&self, mesh: usize, at: &Affine3A) -> order::Bounds {
        moved_bounds(self.host.model.meshes[mesh].bounds(), at)
    }
}

/// Adds table and ball to the chess set.
fn furnish(model: &mut Model) {
    let felt = Material {
        name: "felt".to_owned(),
        base_color: Vec3::new(0.028, 0.075, 0.068),
        ..Material::default()
    };
    let first = model.materials.len();
    model.materials.push(felt);
    model.meshes.push(turned::table(9.6, first));
    model.meshes.push(ball::ball(BALL, first));
}

fn mesh(model: &Model, name: &str) -> Result<usize> {
    let found = model.meshes.iter().position(|mesh| mesh.name == name);
    found.with_context(|| format!("the chess set has no mesh '{name}'"))
}

fn material(model: &Model, name: &str) -> Result<usize> {
    let found = model.materials.iter().position(|material| material.name == name);
    found.with_context(|| format!("the chess set has no material '{name}'"))
}
