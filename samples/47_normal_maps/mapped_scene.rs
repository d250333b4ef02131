//! A scene on the device, with the microfacets and normal maps of its materials and the table of their albedo.

use anyhow::Result;
use common::gpu::{Address, Buffer, Gpu};
use common::scene::{Scene, SceneOnGpu, SceneOptions, input_usage};

use super::microfacets::{MicrofacetRecord, RoughAddresses, RoughOnGpu};
use super::normal_map::NormalMapRecord;

/// The roughness for which each material has its own.
pub const OWN: f32 = -1.0;

/// Settings of all surfaces.
#[derive(Clone, Copy, PartialEq)]
pub struct Settings {
    /// The roughness; negative for each material's own.
    pub roughness: f32,
    /// Multiplies the slopes of normal maps.
    pub strength: f32,
}

common::shader_struct! {
    /// Addresses of what a surface with a normal map needs.
    pub struct MappedAddresses {
        /// The microfacets.
        pub rough: Address<RoughAddresses>,
        /// The normal map of each material.
        pub maps: Address<NormalMapRecord>,
    }
}

/// The traced scene, its microfacets and its normal maps.
pub struct MappedScene {
    /// Meshes, materials, textures.
    pub on_gpu: SceneOnGpu,
    /// A [`MappedAddresses`].
    pub mapped: Buffer,
    microfacets: RoughOnGpu,
    maps: Buffer,
}

impl MappedScene {
    /// Uploads a scene and builds it.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        options: SceneOptions,
        settings: Settings,
    ) -> Result<Self> {
        let on_gpu = SceneOnGpu::new(gpu, &with_colors(scene), options)?;
        let microfacets = RoughOnGpu::new(gpu, &records(scene, settings.roughness))?;
        let maps = maps(gpu, scene, settings.strength)?;
        let mapped = addresses(gpu, &microfacets, &maps)?;
        Ok(Self { on_gpu, mapped, microfacets, maps })
    }

    /// Another scene with the same textures, or other settings.
    ///
    /// # Errors
    /// As [`MappedScene::new`].
    pub fn rebuild(&mut self, gpu: &Gpu, scene: &Scene, settings: Settings) -> Result<()> {
        self.on_gpu.rebuild(gpu, &with_colors(scene), self.on_gpu.options)?;
        self.microfacets.rebuild(gpu, &records(scene, settings.roughness))?;
        self.maps = maps(gpu, scene, settings.strength)?;
        self.mapped = addresses(gpu, &self.microfacets, &self.maps)?;
        Ok(())
    }
}

/// The scene with the colours of its microfacets as base colours, so that the report of a hit contains them.
fn with_colors(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for material in &mut scene.model.materials {
        if let Some(microfacet) = &material.microfacet {
            material.base_color = microfacet.color;
        }
    }
    scene
}

fn records(scene: &Scene, roughness: f32) -> Vec<MicrofacetRecord> {
    let materials = scene.model.materials.iter();
    materials.map(|m| MicrofacetRecord::new(m.microfacet.as_ref(), roughness)).collect()
}

/// The normal maps of the materials that have microfacets: others are shaded as in 11.
fn maps(gpu: &Gpu, scene: &Scene, strength: f32) -> Result<Buffer> {
    let materials = scene.model.materials.iter();
    let maps: Vec<_> = materials
        .map(|m| NormalMapRecord::new(Some(m).filter(|m| m.microfacet.is_some()), strength))
        .collect();
    Buffer::with_data(gpu, "normal maps", &maps, input_usage())
}

fn addresses(gpu: &Gpu, microfacets: &RoughOnGpu, maps: &Buffer) -> Result<Buffer> {
    let addresses =
        MappedAddresses { rough: microfacets.rough.address.into(), maps: maps.address.into() };
    Buffer::with_data(gpu, "addresses of normal maps", &[addresses], input_usage())
}
