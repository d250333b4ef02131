//! A scene on the device, with the microfacets of its materials.

use anyhow::Result;
use common::gpu::Gpu;
use common::scene::{Scene, SceneOnGpu, SceneOptions};

use super::microfacets::{MicrofacetRecord, RoughOnGpu};

/// The traced scene, and its microfacets.
pub struct RoughScene {
    /// Meshes, materials, textures.
    pub on_gpu: SceneOnGpu,
    /// Microfacets, and the table of their albedo.
    pub microfacets: RoughOnGpu,
}

impl RoughScene {
    /// Uploads a scene and builds it. A `roughness` that is not negative replaces every material's own.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, scene: &Scene, options: SceneOptions, roughness: f32) -> Result<Self> {
        let on_gpu = SceneOnGpu::new(gpu, &with_colors(scene), options)?;
        let microfacets = RoughOnGpu::new(gpu, &records(scene, roughness))?;
        Ok(Self { on_gpu, microfacets })
    }

    /// Another scene with the same textures, or another roughness.
    ///
    /// # Errors
    /// As [`RoughScene::new`].
    pub fn rebuild(&mut self, gpu: &Gpu, scene: &Scene, roughness: f32) -> Result<()> {
        self.on_gpu.rebuild(gpu, &with_colors(scene), self.on_gpu.options)?;
        self.microfacets.rebuild(gpu, &records(scene, roughness))
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
