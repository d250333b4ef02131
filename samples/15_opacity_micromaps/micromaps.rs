//! The micromaps of a scene: the states of every triangle whose opacity a texture gives, in device memory.

use std::collections::HashMap;

use anyhow::{Result, ensure};
use common::gpu::{Address, Buffer, Gpu};
use common::scene::{Scene, input_usage};
use serde_json::{Value, json};

use crate::Level;
use crate::alpha::Alpha;
use crate::classify::{self, Rule};
use crate::curve::{self, FINEST};

/// Bytes that the states of a scene may take. A scene file can ask for more than there is.
const MOST_BYTES: usize = 64 << 20;

common::shader_struct! {
    /// Where a shader finds the states of an instance's triangles.
    pub struct Micromap {
        /// 32 bits each, 16 states. Triangle after triangle, in the model's order.
        pub states: Address,
        /// How finely they are cut; -1 where there are none.
        pub level: i32,
        /// Keeps the address of the next at a multiple of 8.
        pub padding: u32,
    }
}

/// What micromaps are made of; where it changes, they are made again.
#[derive(Clone, Copy, PartialEq)]
pub struct Build {
    pub level: Level,
    pub rule: Rule,
}

/// All micromaps of a scene.
pub struct Micromaps {
    /// A [`Micromap`] for each instance.
    pub records: Buffer,
    pub build: Build,
    /// Bytes of all states.
    pub bytes: usize,
    /// How many micro-triangles have each state, by the specification's numbers.
    pub counts: [u64; 4],
    _states: Buffer,
}

impl Micromaps {
    /// Finds the states of each pair of mesh and texture once, however many instances have it.
    ///
    /// # Errors
    /// If there are too many, or memory is short.
    pub fn new(gpu: &Gpu, scene: &Scene, build: Build) -> Result<Self> {
        let textured = |i: usize| {
            let instance = &scene.instances[i];
            let texture = scene.model.materials[instance.material].opacity_texture?;
            build.level.number().map(|_| (instance.mesh, texture))
        };
        let mut pairs: Vec<_> = (0..scene.instances.len()).filter_map(textured).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let level = build.level.number().unwrap_or(0);
        fits(pairs.iter().map(|pair| scene.model.meshes[pair.0].triangles.len()).sum(), level)?;

        let mut alphas = HashMap::new();
        let mut counts = [0; 4];
        let mut arrays = Vec::new();
        for &(mesh, texture) in &pairs {
            let of = &scene.model.textures[texture];
            let alpha =
                alphas.entry(texture).or_insert_with(|| Alpha::new(of.width, of.height, &of.rgba));
            // ANCHOR: states
            let mesh = &scene.model.meshes[mesh];
            let mut bytes = Vec::new();
            for corners in &mesh.triangles {
                let corners = corners.map(|corner| mesh.vertices[corner as usize].uv);
                let states = classify::triangle(alpha, corners, level, build.rule);
                states.iter().for_each(|&state| counts[state as usize] += 1);
                bytes.extend(curve::pack(&states));
            }
            // ANCHOR_END: states
            // Shaders read whole words.
            bytes.resize(bytes.len().next_multiple_of(4), 0);
            arrays.push(bytes);
        }
        let bytes = arrays.iter().map(Vec::len).sum();
        let (states, at) = Buffer::with_arrays(gpu, "opacity states", &arrays, input_usage())?;
        let at: HashMap<_, _> = pairs.into_iter().zip(at).collect();
        let record = |i| match textured(i).map(|pair| at[&pair]) {
            Some(address) => Micromap { states: address.into(), level: level as i32, padding: 0 },
            None => Micromap { states: Address::default(), level: -1, padding: 0 },
        };
        let records: Vec<_> = (0..scene.instances.len()).map(record).collect();
        let records = Buffer::with_data(gpu, "micromaps", &records, input_usage())?;
        Ok(Self { records, build, bytes, counts, _states: states })
    }

    /// How many micro-triangles are unknown, as a part of all.
    pub fn unknown(&self) -> f64 {
        let [_, _, a, b] = self.counts;
        (a + b) as f64 / self.counts.iter().sum::<u64>().max(1) as f64
    }

    pub fn report(&self) -> Value {
        let [transparent, opaque, _, _] = self.counts;
        let unknown = self.unknown();
        json!({
            "bytes": self.bytes, "transparent": transparent, "opaque": opaque, "unknown": unknown,
        })
    }
}

/// Whether the states of so many triangles may be made.
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
