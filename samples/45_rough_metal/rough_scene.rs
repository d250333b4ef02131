//! A scene on the device, with the microfacets of its materials and the table of their albedo.

use anyhow::Result;
use common::gpu::{Address, Buffer, Gpu};
use common::scene::{Material, Microfacet, Scene, SceneOnGpu, SceneOptions, input_usage};

use super::albedo::{Albedo, AlbedoTable};

common::shader_struct! {
    /// A [`Microfacet`] in its form for shaders.
    pub struct MicrofacetRecord {
        /// The square root of alpha; -1 for a material without microfacets.
        pub roughness: f32,
        /// 1 is metal, 0 is an insulator.
        pub metallic: f32,
        /// Index of the texture whose green multiplies the roughness; -1 for none.
        pub roughness_texture: i32,
        /// Index of the texture whose blue multiplies the metalness; -1 for none.
        pub metallic_texture: i32,
    }
}

common::shader_struct! {
    /// Addresses of what a rough surface needs.
    pub struct RoughAddresses {
        /// The microfacets of each material.
        pub microfacets: Address<MicrofacetRecord>,
        /// The table of the albedo.
        pub albedos: Address<Albedo>,
        /// Its mean, for each roughness.
        pub means: Address<Albedo>,
    }
}

/// The traced scene, and its microfacets.
pub struct RoughScene {
    /// Meshes, materials, textures.
    pub on_gpu: SceneOnGpu,
    /// A [`RoughAddresses`].
    pub rough: Buffer,
    records: Buffer,
    albedos: Buffer,
    means: Buffer,
}

impl RoughScene {
    /// Uploads a scene and builds it. A `roughness` that is not negative replaces every material's own.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, scene: &Scene, options: SceneOptions, roughness: f32) -> Result<Self> {
        let table = AlbedoTable::new();
        let on_gpu = SceneOnGpu::new(gpu, &with_colors(scene), options)?;
        let albedos = Buffer::with_data(gpu, "albedos", &table.albedos, input_usage())?;
        let means = Buffer::with_data(gpu, "mean albedos", &table.means, input_usage())?;
        let records = records(gpu, scene, roughness)?;
        let rough = addresses(gpu, &records, &albedos, &means)?;
        Ok(Self { on_gpu, rough, records, albedos, means })
    }

    /// Another scene with the same textures, or another roughness.
    ///
    /// # Errors
    /// As [`RoughScene::new`].
    pub fn rebuild(&mut self, gpu: &Gpu, scene: &Scene, roughness: f32) -> Result<()> {
        self.on_gpu.rebuild(gpu, &with_colors(scene), self.on_gpu.options)?;
        self.records = records(gpu, scene, roughness)?;
        self.rough = addresses(gpu, &self.records, &self.albedos, &self.means)?;
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

fn records(gpu: &Gpu, scene: &Scene, roughness: f32) -> Result<Buffer> {
    let number = |texture: Option<usize>| texture.map_or(-1, |index| index as i32);
    let record = |material: &Material| {
        let Some(microfacet) = &material.microfacet else {
            let (roughness_texture, metallic_texture) = (-1, -1);
            let (roughness, metallic) = (-1.0, 0.0);
            return MicrofacetRecord { roughness, metallic, roughness_texture, metallic_texture };
        };
        let Microfacet { metallic, roughness_texture, metallic_texture, .. } = *microfacet;
        let replaced = roughness >= 0.0;
        MicrofacetRecord {
            roughness: if replaced { roughness } else { microfacet.roughness.clamp(0.0, 1.0) },
            metallic: metallic.clamp(0.0, 1.0),
            roughness_texture: if replaced { -1 } else { number(roughness_texture) },
            metallic_texture: number(metallic_texture),
        }
    };
    let records: Vec<_> = scene.model.materials.iter().map(record).collect();
    Buffer::with_data(gpu, "microfacets", &records, input_usage())
}

fn addresses(gpu: &Gpu, records: &Buffer, albedos: &Buffer, means: &Buffer) -> Result<Buffer> {
    let addresses = RoughAddresses {
        microfacets: records.address.into(),
        albedos: albedos.address.into(),
        means: means.address.into(),
    };
    Buffer::with_data(gpu, "rough addresses", &[addresses], input_usage())
}
