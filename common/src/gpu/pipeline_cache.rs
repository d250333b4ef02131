//! The pipeline cache: what the driver has compiled, kept from one run to the next.
//!
//! There is a file for each device and driver below `target/pipelines`, written whole when the device is
//! closed. A driver must refuse data that is not its own, but may trust what looks like it (Vulkan
//! specification, "Pipeline Cache Header"): so a file that is damaged, or another device's, is not shown to
//! it. Without a cache a pipeline takes longer, nothing else.

use std::fs;
use std::path::{Path, PathBuf};

use ash::{Device, vk};

use crate::files::{sealed, unsealed, write_whole};

/// The most bytes that are kept. A driver never forgets a pipeline, and shaders change: what has grown
/// beyond this is begun anew.
const MOST: usize = 64 << 20;

/// A `VkPipelineCache` and its file.
pub struct PipelineCache {
    /// The Vulkan handle; null if the driver has no memory for it, which Vulkan allows to use.
    pub handle: vk::PipelineCache,
    file: PathBuf,
    most: usize,
    /// What the file held.
    known: Vec<u8>,
}

impl PipelineCache {
    /// The cache of a device, with what earlier runs have left.
    pub fn open(device: &Device, properties: &vk::PhysicalDeviceProperties) -> Self {
        let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../target/pipelines"));
        Self::open_in(folder, MOST, device, properties)
    }

    fn open_in(
        folder: &Path,
        most: usize,
        device: &Device,
        properties: &vk::PhysicalDeviceProperties,
    ) -> Self {
        let start = header(properties);
        let name: String = start[8..].iter().map(|byte| format!("{byte:02x}")).collect();
        let file = folder.join(name).with_extension("cache");
        let known = fs::read(&file).ok().and_then(|bytes| unsealed(&bytes).map(<[u8]>::to_vec));
        let known = known.filter(|known| known.starts_with(&start)).unwrap_or_default();
        let info = vk::PipelineCacheCreateInfo::default().initial_data(&known);
        // SAFETY: the device is alive; the data is what this device has given, by its header and seal.
        let handle = unsafe { device.create_pipeline_cache(&info, None) }.unwrap_or_default();
        Self { handle, file, most, known }
    }

    /// Writes what the driver has learned, if it has, and destroys the cache.
    pub fn close(&mut self, device: &Device) {
        if self.handle == vk::PipelineCache::null() {
            return;
        }
        // SAFETY: the cache is the device's, and nothing uses it any more.
        let data = unsafe { device.get_pipeline_cache_data(self.handle) }.unwrap_or_default();
        if data.len() > self.most {
            let _ = fs::remove_file(&self.file);
        } else if data != self.known {
            // A cache that cannot be written costs time at the next start, nothing else.
            let _ = self.file.parent().map(fs::create_dir_all);
            let _ = write_whole(&self.file, &sealed(&data));
        }
        // SAFETY: as above.
        unsafe { device.destroy_pipeline_cache(self.handle, None) };
        self.handle = vk::PipelineCache::null();
    }
}

/// `VkPipelineCacheHeaderVersionOne`, with which the data of this device and driver begins: its size, its
/// version, vendor, device, and the driver's mark for what it can read.
fn header(properties: &vk::PhysicalDeviceProperties) -> Vec<u8> {
    let version = vk::PipelineCacheHeaderVersion::ONE.as_raw() as u32;
    let words = [32, version, properties.vendor_id, properties.device_id].map(u32::to_le_bytes);
    [words.concat(), properties.pipeline_cache_uuid.to_vec()].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{Gpu, GpuOptions, Requirements};

    /// A device, and what it says of itself.
    fn gpu() -> (Gpu, vk::PhysicalDeviceProperties) {
        let requirements = Requirements::ray_tracing();
        let gpu = Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).unwrap();
        // SAFETY: the instance is alive.
        let properties =
            unsafe { gpu.instance.get_physical_device_properties(gpu.physical_device) };
        (gpu, properties)
    }

    /// Opens the cache, closes it again, and tells how many bytes the driver was given.
    fn run(folder: &Path, most: usize, gpu: &Gpu, of: &vk::PhysicalDeviceProperties) -> usize {
        let mut cache = PipelineCache::open_in(folder, most, &gpu.device, of);
        assert_ne!(cache.handle, vk::PipelineCache::null());
        cache.close(&gpu.device);
        cache.known.len()
    }

    fn only_file(folder: &Path) -> PathBuf {
        let files: Vec<_> = folder.read_dir().unwrap().map(|file| file.unwrap().path()).collect();
        assert_eq!(files.len(), 1, "{files:?}");
        files[0].clone()
    }

    #[test]
    fn a_second_start_has_what_the_first_has_left() {
        let (gpu, properties) = gpu();
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("made when there is something to keep");
        assert_eq!(run(&folder, MOST, &gpu, &properties), 0);
        let kept = run(&folder, MOST, &gpu, &properties);
        assert!(kept >= 32, "{kept} bytes");
        assert_eq!(fs::metadata(only_file(&folder)).unwrap().len(), kept as u64 + 8);
    }

    #[test]
    fn a_damaged_file_is_ignored_and_replaced() {
        let (gpu, properties) = gpu();
        let folder = tempfile::tempdir().unwrap();
        run(folder.path(), MOST, &gpu, &properties);
        let file = only_file(folder.path());
        let good = fs::read(&file).unwrap();
        let cut = good[..good.len() / 2].to_vec();
        let mut flipped = good.clone();
        flipped[20] ^= 1;
        for damaged in [Vec::new(), vec![0; 40], cut, flipped] {
            fs::write(&file, damaged).unwrap();
            assert_eq!(run(folder.path(), MOST, &gpu, &properties), 0);
            assert_eq!(fs::read(&file).unwrap(), good);
        }
    }

    #[test]
    fn what_another_driver_has_left_is_not_shown_to_this_one() {
        let (gpu, properties) = gpu();
        let folder = tempfile::tempdir().unwrap();
        // By the name of a driver that this one is not, the file holds what this one has left.
        let mut other = properties;
        other.pipeline_cache_uuid[0] ^= 1;
        for _ in 0..2 {
            assert_eq!(run(folder.path(), MOST, &gpu, &other), 0);
            only_file(folder.path());
        }
    }

    #[test]
    fn what_has_grown_too_large_is_begun_anew() {
        let (gpu, properties) = gpu();
        let folder = tempfile::tempdir().unwrap();
        run(folder.path(), MOST, &gpu, &properties);
        assert!(run(folder.path(), 16, &gpu, &properties) >= 32);
        assert_eq!(folder.path().read_dir().unwrap().count(), 0);
    }
}
