//! A scene on the device, with the microfacets and normal maps of its materials and the table of their albedo.

use anyhow::Result;
use common::gpu::{Address, Buffer, Gpu};
use common::scene::{Material, Microfacet, Scene, SceneOnGpu, SceneOptions, input_usage};

use super::albedo::{Albedo, AlbedoTable};

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
        /// Index of the texture of normals; -1 for none.
        pub normal_texture: i32,
        /// Multiplies x and y of its normals.
        pub normal_scale: f32,
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

/// The traced scene, its microfacets and its normal maps.
pub struct MappedScene {
    /// Meshes, materials, textures.
    pub on_gpu: SceneOnGpu,
    /// A [`RoughAddresses`].
    pub rough: Buffer,
    records: Buffer,
    albedos: Buffer,
    means: Buffer,
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
        let table = AlbedoTable::new();
        let on_gpu = SceneOnGpu::new(gpu, &with_colors(scene), options)?;
        let albedos = Buffer::with_data(gpu, "albedos", &table.albedos, input_usage())?;
        let means = Buffer::with_data(gpu, "mean albedos", &table.means, input_usage())?;
        let records = records(gpu, scene, settings)?;
        let rough = addresses(gpu, &records, &albedos, &means)?;
        Ok(Self { on_gpu, rough, records, albedos, means })
    }

    /// Another scene with the same textures, or other settings.
    ///
    /// # Errors
    /// As [`MappedScene::new`].
    pub fn rebuild(&mut self, gpu: &Gpu, scene: &Scene, settings: Settings) -> Result<()> {
        self.on_gpu.rebuild(gpu, &with_colors(scene), self.on_gpu.options)?;
        self.records = records(gpu, scene, settings)?;
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

fn records(gpu: &Gpu, scene: &Scene, Settings { roughness, strength }: Settings) -> Result<Buffer> {
    let number = |texture: Option<usize>| texture.map_or(-1, |index| index as i32);
    let record = |material: &Material| {
        let Some(microfacet) = &material.microfacet else {
            return MicrofacetRecord {
                roughness: -1.0,
                metallic: 0.0,
                roughness_texture: -1,
                metallic_texture: -1,
                normal_texture: -1,
                normal_scale: 0.0,
            };
        };
        let Microfacet { metallic, roughness_texture, metallic_texture, .. } = *microfacet;
        let replaced = roughness >= 0.0;
        MicrofacetRecord {
            roughness: if replaced { roughness } else { microfacet.roughness.clamp(0.0, 1.0) },
            metallic: metallic.clamp(0.0, 1.0),
            roughness_texture: if replaced { -1 } else { number(roughness_texture) },
            metallic_texture: number(metallic_texture),
            normal_texture: number(material.normal_texture),
            normal_scale: material.normal_scale * strength,
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
