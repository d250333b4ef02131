//! The microfacets of materials on the device, and the table of their albedo.

use anyhow::Result;
use common::gpu::{Address, Buffer, Gpu};
use common::scene::{Microfacet, input_usage};

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

/// Microfacets and table on the device.
pub struct RoughOnGpu {
    /// A [`RoughAddresses`].
    pub rough: Buffer,
    records: Buffer,
    albedos: Buffer,
    means: Buffer,
}

impl RoughOnGpu {
    /// Computes the table, and uploads it with the record of each material.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, records: &[MicrofacetRecord]) -> Result<Self> {
        let table = AlbedoTable::new();
        let albedos = Buffer::with_data(gpu, "albedos", &table.albedos, input_usage())?;
        let means = Buffer::with_data(gpu, "mean albedos", &table.means, input_usage())?;
        let records = Buffer::with_data(gpu, "microfacets", records, input_usage())?;
        let rough = addresses(gpu, &records, &albedos, &means)?;
        Ok(Self { rough, records, albedos, means })
    }

    /// Other materials.
    ///
    /// # Errors
    /// As [`RoughOnGpu::new`].
    pub fn rebuild(&mut self, gpu: &Gpu, records: &[MicrofacetRecord]) -> Result<()> {
        self.records = Buffer::with_data(gpu, "microfacets", records, input_usage())?;
        self.rough = addresses(gpu, &self.records, &self.albedos, &self.means)?;
        Ok(())
    }
}

impl MicrofacetRecord {
    /// The record of a material. A `roughness` that is not negative replaces its own.
    pub fn new(microfacet: Option<&Microfacet>, roughness: f32) -> Self {
        let number = |texture: Option<usize>| texture.map_or(-1, |index| index as i32);
        let Some(microfacet) = microfacet else {
            let (roughness_texture, metallic_texture) = (-1, -1);
            return Self { roughness: -1.0, metallic: 0.0, roughness_texture, metallic_texture };
        };
        let Microfacet { metallic, roughness_texture, metallic_texture, .. } = *microfacet;
        let replaced = roughness >= 0.0;
        Self {
            roughness: if replaced { roughness } else { microfacet.roughness.clamp(0.0, 1.0) },
            metallic: metallic.clamp(0.0, 1.0),
            roughness_texture: if replaced { -1 } else { number(roughness_texture) },
            metallic_texture: number(metallic_texture),
        }
    }
}

fn addresses(gpu: &Gpu, records: &Buffer, albedos: &Buffer, means: &Buffer) -> Result<Buffer> {
    let addresses = RoughAddresses {
        microfacets: records.address.into(),
        albedos: albedos.address.into(),
        means: means.address.into(),
    };
    Buffer::with_data(gpu, "rough addresses", &[addresses], input_usage())
}
