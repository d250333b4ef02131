//! The one `Gpu`: instance, device, queue, allocator and, if required, the ray tracing entry points.
//!
//! Everything that lives on the device holds a clone, so the device is destroyed last, whatever the order of a
//! sample's fields. Work is submitted and waited for (one frame in flight), so a sample may replace or drop
//! anything between frames without rules for lifetimes.

use std::collections::BTreeMap;
use std::ffi::CString;
use std::mem::ManuallyDrop;
use std::ops::Deref;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use anyhow::{Context as _, Result};
use ash::{Device, ext, khr, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};

use crate::files::cache;
use crate::gpu::Asked;
use crate::gpu::accel::Level;
use crate::gpu::check::driver_shim::{DriverShim, Plain};
use crate::gpu::check::statistics::Statistics;
use crate::gpu::check::validation::{Heard, Messages};
use crate::gpu::device::instance::{Vulkan, WindowHandles};
use crate::gpu::device::requirements::Requirements;
use crate::gpu::device::threads;
use crate::gpu::device::{self, Candidate};
use crate::gpu::memory::arrays::Arrays;
use crate::gpu::pipeline::cache::PipelineCache;
use crate::output;

/// Options for creating a [`Gpu`].
#[derive(Clone)]
pub struct GpuOptions<'a> {
    /// The features and extensions the sample needs, and no more.
    pub requirements: Requirements,
    /// A device's number or a part of its name; `None` selects the one named by `GPU`, else the best.
    pub device: Option<&'a str>,
    /// Turn on validation and synchronization validation.
    pub validate: bool,
    /// Collect shaders' `debugPrintfEXT` output, if the validation layer is installed; without `validate`.
    pub prints: bool,
    /// The window to draw to, if any: the device must have a queue that supports it.
    pub window: Option<WindowHandles>,
    /// The driver to emulate; [`Plain`] for the actual one.
    pub driver_shim: Arc<dyn DriverShim>,
}

impl Default for GpuOptions<'_> {
    fn default() -> Self {
        let requirements = Requirements::default();
        Self {
            requirements,
            device: None,
            validate: false,
            prints: false,
            window: None,
            driver_shim: Arc::new(Plain),
        }
    }
}

/// A shared handle to the device and everything that belongs to it.
#[derive(Clone)]
pub struct Gpu(Arc<GpuContext>);

/// The contents of a [`Gpu`], with all properties of the chosen device. Raw handles are public: a chapter may call
/// Vulkan itself.
pub struct GpuContext {
    /// The device's commands.
    pub device: Device,
    /// `VK_KHR_acceleration_structure`; each function panics unless the sample requires ray tracing.
    pub acceleration_structure: khr::acceleration_structure::Device,
    /// `VK_KHR_ray_tracing_pipeline`; likewise.
    pub ray_tracing_pipeline: khr::ray_tracing_pipeline::Device,
    /// `VK_KHR_push_descriptor`.
    pub push_descriptor: khr::push_descriptor::Device,
    /// `VK_KHR_pipeline_executable_properties`, if requested and supported.
    pub executable_properties: Option<khr::pipeline_executable_properties::Device>,
    /// The chosen device: its name, its limits, and the enabled features.
    pub chosen: Candidate,
    /// The one queue in use: compute, and graphics where the device has it.
    pub queue: vk::Queue,
    /// Pipelines the driver compiled in earlier runs, and in this one.
    pub pipeline_cache: PipelineCache,
    /// The sample's requirements.
    pub requirements: Requirements,
    /// The layer between this program and the driver.
    pub driver_shim: Arc<dyn DriverShim>,
    /// Device memory, shared with the panel's painter.
    pub allocator: ManuallyDrop<Arc<Mutex<Allocator>>>,
    statistics: Mutex<Statistics>,
    /// The existing acceleration structures, by address.
    levels: Mutex<BTreeMap<vk::DeviceAddress, Weak<Level>>>,
    arrays: Mutex<Arrays>,
    pub(in crate::gpu) command_pool: vk::CommandPool,
    names: ext::debug_utils::Device,
    /// The loader and the instance, destroyed last.
    pub vulkan: Vulkan,
}

impl Deref for GpuContext {
    type Target = Candidate;

    fn deref(&self) -> &Candidate {
        &self.chosen
    }
}

impl Deref for Gpu {
    type Target = GpuContext;

    fn deref(&self) -> &GpuContext {
        &self.0
    }
}

impl Gpu {
    /// Creates an instance, chooses a device and opens it with only the required features and extensions.
    ///
    /// # Errors
    /// If there is no loader, no suitable device, or no validation layer although one is required.
    pub fn new(options: &GpuOptions) -> Result<Self> {
        let mut options = options.clone();
        options.requirements = options.driver_shim.requirements(options.requirements);
        let heard = match (options.validate, options.prints) {
            (true, _) => Some(Heard::Mistakes),
            (false, true) => Some(Heard::Prints),
            (false, false) => None,
        };
        let vulkan = Vulkan::new(heard, options.window.as_ref())?;
        let mut found = device::candidates(&vulkan.instance, &options.requirements)?;
        if let Some(window) = &options.window {
            device::require_presentation(&vulkan, window, &mut found)?;
        }
        let chosen = device::choose(found, options.device.or(device::named()))?;
        let cannot = format!("cannot open {}", chosen.name);
        let gpu = Self::open(vulkan, chosen, options).context(cannot)?;
        gpu.driver_shim.opened(&gpu)?;
        Ok(gpu)
    }

    /// Opens the chosen device.
    ///
    /// # Errors
    /// If memory or threads are short, or the device is lost.
    pub fn open(vulkan: Vulkan, chosen: Candidate, options: GpuOptions) -> Result<Self> {
        if chosen.software {
            threads::ensure_threads()?;
        }
        // A loader that runs out of memory here keeps its lock (1.3.239) and would later wait for it for ever, so an
        // instance whose device cannot be opened is left to the end of the process.
        let vulkan = ManuallyDrop::new(vulkan);
        let device = device::create(&vulkan.instance, &chosen)?;
        let instance = &vulkan.instance;
        // SAFETY: the device was created with one queue of this family.
        let queue = unsafe { device.get_device_queue(chosen.queue_family, 0) };
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device: chosen.physical_device,
            debug_settings: Default::default(),
            buffer_device_address: true,
            allocation_sizes: Default::default(),
        });
        let allocator = allocator?;
        let pool = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(chosen.queue_family);
        // SAFETY: the queue family belongs to this device.
        let command_pool = unsafe { device.create_command_pool(&pool, None)? };
        let features = &chosen.features;
        let tells_executables = features.executable.pipeline_executable_info == vk::TRUE;
        let gpu = Self(Arc::new(GpuContext {
            acceleration_structure: khr::acceleration_structure::Device::new(instance, &device),
            ray_tracing_pipeline: khr::ray_tracing_pipeline::Device::new(instance, &device),
            push_descriptor: khr::push_descriptor::Device::new(instance, &device),
            executable_properties: tells_executables
                .then(|| khr::pipeline_executable_properties::Device::new(instance, &device)),
            pipeline_cache: PipelineCache::open(
                cache::folder("pipelines").as_deref(),
                &device,
                &chosen.properties,
            ),
            names: ext::debug_utils::Device::new(instance, &device),
            allocator: ManuallyDrop::new(Arc::new(Mutex::new(allocator))),
            statistics: Mutex::default(),
            levels: Mutex::default(),
            arrays: Mutex::default(),
            command_pool,
            requirements: options.requirements,
            driver_shim: options.driver_shim,
            device,
            chosen,
            queue,
            vulkan: ManuallyDrop::into_inner(vulkan),
        }));
        gpu.name_object(gpu.queue, "queue");
        gpu.name_object(gpu.command_pool, "commands");
        gpu.name_object(gpu.pipeline_cache.handle, "pipeline cache");
        Ok(gpu)
    }

    /// Gives an object a name for validation messages and debuggers.
    pub fn name_object<T: vk::Handle + Copy>(&self, handle: T, name: &str) {
        // Optional objects may be null.
        if handle.is_null() {
            return;
        }
        let name = CString::new(name).unwrap_or_default();
        let info =
            vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the handle is alive and belongs to this device. Failing to set a
        // name is not an error.
        let _ = unsafe { self.names.set_debug_utils_object_name(&info) };
    }

    /// The validation messages, now and after the device is destroyed: a leak is reported last.
    pub fn validation(&self) -> Arc<Messages> {
        let messenger = self.vulkan.messenger.as_ref();
        messenger.map_or_else(Arc::default, |messenger| messenger.messages.clone())
    }

    /// Statistics since the start, or since the last [`Gpu::take_statistics`].
    pub fn statistics(&self) -> Statistics {
        self.statistics.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Statistics since the last call, for a caller that polls.
    pub fn take_statistics(&self) -> Statistics {
        let mut all = self.statistics.lock().unwrap_or_else(PoisonError::into_inner);
        let Statistics { acceleration_structure_bytes, warnings, .. } = &*all;
        let (acceleration_structure_bytes, warnings) =
            (*acceleration_structure_bytes, warnings.clone());
        let rest = Statistics { acceleration_structure_bytes, warnings, ..Statistics::default() };
        std::mem::replace(&mut all, rest)
    }

    /// Updates the statistics.
    pub(in crate::gpu) fn count(&self, add: impl FnOnce(&mut Statistics)) {
        add(&mut self.statistics.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// Replaces the warnings of the object of this name, and prints those not printed before.
    pub fn warn(&self, name: &str, warnings: Vec<String>) {
        self.count(|statistics| {
            let known = |line: &String| statistics.warnings.iter().any(|(_, told)| told == line);
            warnings
                .iter()
                .filter(|line| !known(line))
                .for_each(|line| output::warn(std::slice::from_ref(line)));
            statistics.warnings.retain(|(of, _)| of != name);
            statistics.warnings.extend(warnings.into_iter().map(|line| (name.to_owned(), line)));
        });
    }

    /// The acceleration structure of this device at this address, if it still exists.
    pub(crate) fn level_at(&self, address: vk::DeviceAddress) -> Option<Arc<Level>> {
        self.levels().get(&address).and_then(Weak::upgrade)
    }

    /// Notes the hit records of a top level's instances.
    pub(crate) fn note_asked(&self, asked: &Asked) {
        self.count(|statistics| statistics.asked = asked.clone());
    }

    pub(in crate::gpu) fn note_level(&self, level: &Arc<Level>) {
        self.levels().insert(level.address, Arc::downgrade(level));
    }

    pub(in crate::gpu) fn forget_level(&self, address: vk::DeviceAddress) {
        self.levels().remove(&address);
    }

    fn levels(&self) -> MutexGuard<'_, BTreeMap<vk::DeviceAddress, Weak<Level>>> {
        self.levels.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The arrays that have an address.
    pub(in crate::gpu) fn arrays(&self) -> MutexGuard<'_, Arrays> {
        self.arrays.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// True if this run is validated.
    pub(in crate::gpu) fn is_validated(&self) -> bool {
        let messenger = self.vulkan.messenger.as_ref();
        messenger.is_some_and(|messenger| messenger.messages.heard() == Heard::Mistakes)
    }

    /// Bytes of device memory in use, buffers and images together.
    pub fn allocated_bytes(&self) -> u64 {
        self.allocator.lock().map_or(0, |a| a.generate_report().total_allocated_bytes)
    }
}

impl Drop for GpuContext {
    fn drop(&mut self) {
        // SAFETY: the last clone is gone, so nothing made from the device is left; the order is
        // children before parents. `allocator` is not used again.
        unsafe {
            let _ = self.device.device_wait_idle();
            ManuallyDrop::drop(&mut self.allocator);
            self.pipeline_cache.close(&self.device);
            self.device.destroy_command_pool(self.command_pool, None);
            self.device.destroy_device(None);
        }
    }
}
