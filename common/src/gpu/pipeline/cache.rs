//! The pipeline cache: the driver's compiled shaders, stored between runs.
//!
//! There is one file per device and driver in the cache `pipelines`, written whole when the device is closed. A
//! driver must refuse data that is not its own, but may trust data that looks like its own (Vulkan specification,
//! "Pipeline Cache Header"), so a damaged file, or one of another device, is never passed to it. Without a cache,
//! creating a pipeline only takes longer.

use std::fs;
use std::path::{Path, PathBuf};

use ash::{Device, vk};

use crate::files::{read_sealed, write_sealed};

/// The most bytes kept. A driver never drops a pipeline, and shaders change, so a cache that has grown beyond this
/// starts from empty.
const MOST: usize = 64 << 20;

/// A `VkPipelineCache` and its file.
pub struct PipelineCache {
    /// The Vulkan handle; null if the driver has no memory for it, which Vulkan allows.
    pub handle: vk::PipelineCache,
    /// `None` if the system has no place for caches.
    file: Option<PathBuf>,
    most: usize,
    /// Contents of the file when it was read.
    known: Vec<u8>,
}

impl PipelineCache {
    /// The cache of a device, with the data that earlier runs left in a folder.
    pub fn open(
        folder: Option<&Path>,
        device: &Device,
        properties: &vk::PhysicalDeviceProperties,
    ) -> Self {
        let start = header(properties);
        let name: String = start[8..].iter().map(|byte| format!("{byte:02x}")).collect();
        let file = folder.map(|folder| folder.join(name).with_extension("cache"));
        let known = file.as_deref().and_then(read_sealed).filter(|known| known.starts_with(&start));
        let known = known.unwrap_or_default();
        let info = vk::PipelineCacheCreateInfo::default().initial_data(&known);
        // SAFETY: the device is alive; the data is what this device has given, by its header and seal.
        let handle = unsafe { device.create_pipeline_cache(&info, None) }.unwrap_or_default();
        Self { handle, file, most: MOST, known }
    }

    /// Writes the driver's data, if it has grown, and destroys the cache.
    pub fn close(&mut self, device: &Device) {
        if self.handle == vk::PipelineCache::null() {
            return;
        }
        // SAFETY: the cache is the device's, and nothing uses it any more.
        let data = unsafe { device.get_pipeline_cache_data(self.handle) }.unwrap_or_default();
        if let Some(file) = &self.file {
            if data.len() > self.most {
                let _ = fs::remove_file(file);
            } else if data != self.known {
                write_sealed(file, &data);
            }
        }
        // SAFETY: as above.
        unsafe { device.destroy_pipeline_cache(self.handle, None) };
        self.handle = vk::PipelineCache::null();
    }
}

/// `VkPipelineCacheHeaderVersionOne`, with which this device and driver's data begins: its size, its version,
/// vendor, device, and the driver's identifier for data it can read.
fn header(properties: &vk::PhysicalDeviceProperties) -> Vec<u8> {
    let version = vk::PipelineCacheHeaderVersion::ONE.as_raw() as u32;
    let words = [32, version, properties.vendor_id, properties.device_id].map(u32::to_le_bytes);
    [words.concat(), properties.pipeline_cache_uuid.to_vec()].concat()
}

#[cfg(test)]
mod tests;
