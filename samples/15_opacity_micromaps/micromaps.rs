//! The micromaps of a scene: the states of every triangle whose opacity a texture gives, in device memory.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Mutex, PoisonError};

use anyhow::{Result, ensure};
use common::app::Progress;
use common::gpu::{Address, Buffer, Gpu};
use common::scene::{Scene, SceneOnGpu, input_usage};
use common::workers;
use serde_json::{Value, json};

use crate::alpha::Alpha;
use crate::classify::{self, Rule};
use crate::curve::{self, FINEST};
use crate::on_device::OnDevice;
use crate::{Level, Way};

/// The largest size of a scene's states in bytes. A scene file could request more memory than there is.
const MOST_BYTES: usize = 64 << 20;

common::shader_struct! {
    /// The address of the states of an instance's triangles.
    pub struct Micromap {
        /// 32 bits each, 16 states. Triangle after triangle, in the model's order.
        pub states: Address,
        /// Subdivision level; -1 where there are no states.
        pub level: i32,
        /// Keeps the address of the next at a multiple of 8.
        pub padding: u32,
    }
}

/// Parameters of the micromaps; a change rebuilds them.
#[derive(Clone, Copy, PartialEq)]
pub struct Build {
    pub level: Level,
    pub rule: Rule,
    pub way: Way,
}

/// The owner of a set of states: a mesh, and the texture that gives its opacity.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pair {
    pub mesh: usize,
    texture: usize,
}

impl Pair {
    /// The micromap of an instance, if it has such a texture.
    pub fn of(scene: &Scene, instance: usize) -> Option<Self> {
        let instance = &scene.instances[instance];
        let texture = scene.model.materials[instance.material].opacity_texture?;
        Some(Self { mesh: instance.mesh, texture })
    }
}

/// All micromaps of a scene.
pub struct Micromaps {
    /// A [`Micromap`] for each instance.
    pub records: Buffer,
    /// The same states, where traversal reads them.
    pub on_device: Option<OnDevice>,
    pub build: Build,
    /// Subdivision level, if there is one.
    pub level: Option<u32>,
    /// Bytes of all states.
    pub bytes: usize,
    /// Number of micro-triangles in each state, by the specification's numbers.
    pub counts: [u64; 4],
    _states: Buffer,
}

impl Micromaps {
    /// Finds the states of each pair of mesh and texture once, however many instances have it.
    ///
    /// # Errors
    /// If there are too many, memory is short, or the device shall read them and cannot.
    pub fn new(gpu: &Gpu, scene: &Scene, meshes: &SceneOnGpu, build: Build) -> Result<Self> {
        let level = build.level.number().map(|level| fitted(gpu, level, build.way));
        let level = level.transpose()?;
        let pairs = (0..scene.instances.len()).filter_map(|i| Pair::of(scene, i));
        let mut pairs: Vec<_> = pairs.filter(|_| level.is_some()).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let cut = level.unwrap_or(0);
        let triangles = |pair: &Pair| scene.model.meshes[pair.mesh].triangles.len();
        let triangles = pairs.iter().map(triangles).sum();
        fits(triangles, cut)?;

        let mut alphas = HashMap::new();
        let mut counts = [0; 4];
        let mut arrays = BTreeMap::new();
        let progress = Mutex::new(Progress::new(triangles as u64, "triangles"));
        for pair in pairs {
            let of = &scene.model.textures[pair.texture];
            let alpha = alphas
                .entry(pair.texture)
                .or_insert_with(|| Alpha::new(of.width, of.height, &of.rgba));
            let mesh = &scene.model.meshes[pair.mesh];
            let states = workers::each(&mesh.triangles, |corners| {
                let corners = corners.map(|corner| mesh.vertices[corner as usize].uv);
                let states = classify::triangle(alpha, corners, cut, build.rule);
                progress.lock().unwrap_or_else(PoisonError::into_inner).step();
                (curve::pack(&states), curve::tally(&states))
            });
            let mut bytes = Vec::with_capacity(states.len() * curve::bytes(cut) + 3);
            for (packed, tally) in states {
                bytes.extend(packed);
                counts.iter_mut().zip(tally).for_each(|(sum, count)| *sum += count);
            }
            arrays.insert(pair, bytes);
        }
        let on_device = match (level, build.way) {
            (Some(level), Way::Device) => Some(OnDevice::new(gpu, scene, meshes, &arrays, level)?),
            _ => None,
        };
        // Shaders read whole words.
        arrays.values_mut().for_each(|bytes| bytes.resize(bytes.len().next_multiple_of(4), 0));
        let bytes = arrays.values().map(Vec::len).sum();
        let (states, at) =
            Buffer::with_arrays(gpu, "opacity states", arrays.values(), input_usage())?;
        let at: BTreeMap<_, _> = arrays.into_keys().zip(at).collect();
        let record = |i| match Pair::of(scene, i).and_then(|pair| at.get(&pair)) {
            Some(&address) => Micromap { states: address.into(), level: cut as i32, padding: 0 },
            None => Micromap { states: Address::default(), level: -1, padding: 0 },
        };
        let records: Vec<_> = (0..scene.instances.len()).map(record).collect();
        let records = Buffer::with_data(gpu, "micromaps", &records, input_usage())?;
        Ok(Self { records, on_device, build, level, bytes, counts, _states: states })
    }

    /// The fraction of micro-triangles that are unknown.
    pub fn unknown(&self) -> f64 {
        let [_, _, a, b] = self.counts;
        (a + b) as f64 / self.counts.iter().sum::<u64>().max(1) as f64
    }

    pub fn report(&self) -> Value {
        let [transparent, opaque, _, _] = self.counts;
        let unknown = self.unknown();
        json!({
            "level": self.level, "bytes": self.bytes, "transparent": transparent, "opaque": opaque,
            "unknown": unknown,
        })
    }
}

/// The level, or the finest that the device takes, if that shall read the states.
///
/// # Errors
/// If it cannot read any.
fn fitted(gpu: &Gpu, level: u32, way: Way) -> Result<u32> {
    let finest = if way == Way::Device { OnDevice::finest(gpu)? } else { FINEST };
    let line =
        format!("{} takes micromaps up to level {finest}: it gets those, not {level}", gpu.name);
    gpu.warn("micromaps", if level > finest { vec![line] } else { Vec::new() });
    Ok(level.min(finest))
}

/// Checks that the states of so many triangles fit in memory.
fn fits(triangles: usize, level: u32) -> Result<()> {
    let bytes = |level| triangles.saturating_mul(curve::bytes(level));
    let finest = (0..=FINEST).rev().find(|&level| bytes(level) <= MOST_BYTES);
    let advice = match finest {
        Some(finest) => format!("level {finest} fits"),
        None => "no level fits".into(),
    };
    ensure!(
        bytes(level) <= MOST_BYTES,
        "micromaps of level {level} for {triangles} triangles take {} bytes, and at most {MOST_BYTES} are made: \
         {advice}",
        bytes(level)
    );
    Ok(())
}
