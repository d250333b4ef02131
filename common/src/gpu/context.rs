//! The one `Gpu`: instance, device, queue, allocator and the ray tracing entry points.
//!
//! Everything that lives on the device holds a clone, so the device is destroyed last, whatever the
//! order of a sample's fields. Work is submitted and waited for (one frame in flight): a sample may
//! replace or drop anything between frames and needs no rule for lifetimes.

use std::ffi::CString;
use std::mem::ManuallyDrop;
use std::ops::Deref;
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Context as _, Result};
use ash::{Device, Entry, Instance, ext, khr, nv, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};

use super::device::{self, Candidate};
use super::emulation::{Emulation, Plain};
use super::instance::{self, WindowHandles};
use super::limits::Limits;
use super::pipeline_cache::PipelineCache;
use super::requirements::Requirements;
use super::statistics::Statistics;
use super::threads;
use super::validation::Messages;

/// How a [`Gpu`] shall be made.
#[derive(Clone)]
pub struct GpuOptions<'a> {
    /// Features and extensions, no more than the sample needs.
    pub requirements: Requirements,
    /// A device's number or a part of its name; `None` takes the one that `GPU` names, else the best.
    pub device: Option<&'a str>,
    /// Turn on validation and synchronization validation.
    pub validate: bool,
    /// The window to draw to, if any: the device must have a queue that can.
    pub window: Option<WindowHandles>,
    /// The driver to be emulated, [`Plain`] for the one that there is.
    pub emulation: Arc<dyn Emulation>,
}

impl Default for GpuOptions<'_> {
    fn default() -> Self {
        let requirements = Requirements::default();
        Self {
            requirements,
            device: None,
            validate: false,
            window: None,
            emulation: Arc::new(Plain),
        }
    }
}

/// A shared handle to the device and all that belongs to it.
#[derive(Clone)]
pub struct Gpu(Arc<GpuContext>);

/// What a [`Gpu`] gives access to. Raw handles are public: a chapter may call Vulkan itself.
pub struct GpuContext {
    /// The device's commands.
    pub device: Device,
    /// `VK_KHR_acceleration_structure`.
    pub acceleration_structure: khr::acceleration_structure::Device,
    /// `VK_KHR_ray_tracing_pipeline`.
    pub ray_tracing_pipeline: khr::ray_tracing_pipeline::Device,
    /// `VK_KHR_push_descriptor`.
    pub push_descriptor: khr::push_descriptor::Device,
    /// `VK_KHR_pipeline_executable_properties`, where it was wished for and is there.
    pub executable_properties: Option<khr::pipeline_executable_properties::Device>,
    /// The instance's commands.
    pub instance: Instance,
    /// The loader.
    pub entry: Entry,
    /// The chosen device.
    pub physical_device: vk::PhysicalDevice,
    /// The one queue in use: compute, and graphics where the device has it.
    pub queue: vk::Queue,
    /// The queue's family.
    pub queue_family: u32,
    /// The device's name.
    pub name: String,
    /// Its driver, in its maker's words.
    pub driver: String,
    /// Whether it is a driver that runs on the CPU.
    pub software: bool,
    /// The limits that ray tracing code must heed.
    pub limits: Limits,
    /// Whether shaders may sort rays by what they met: the device offers it, and the sample asks for it.
    pub invocation_reorder: bool,
    /// What the driver has compiled in earlier runs, and in this one.
    pub pipeline_cache: PipelineCache,
    /// What the sample has asked for.
    pub requirements: Requirements,
    /// What stands between this program and the driver.
    pub emulation: Arc<dyn Emulation>,
    /// Device memory, shared with the panel's painter.
    pub allocator: ManuallyDrop<Arc<Mutex<Allocator>>>,
    statistics: Mutex<Statistics>,
    pub(super) command_pool: Mutex<vk::CommandPool>,
    debug: Option<Debug>,
}

struct Debug {
    names: ext::debug_utils::Device,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT, Arc<Messages>)>,
}

impl Deref for Gpu {
    type Target = GpuContext;

    fn deref(&self) -> &GpuContext {
        &self.0
    }
}

impl Gpu {
    /// Creates an instance, chooses a device and opens it with just what is asked for.
    ///
    /// # Errors
    /// If there is no loader, no suitable device, or no validation layer where one is asked for.
    pub fn new(options: &GpuOptions) -> Result<Self> {
        let wanted = options.emulation.requirements(options.requirements.clone());
        let entry = instance::load()?;
        let messages = if options.validate { Some(Messages::new(&entry)?) } else { None };
        let (instance, has_debug_utils) =
            instance::create(&entry, messages.as_deref(), options.window.as_ref())?;
        let chosen = device::candidates(&instance, &wanted).and_then(|mut found| {
            if let Some(window) = &options.window {
                device::require_presentation(&entry, &instance, window, &mut found)?;
            }
            device::choose(found, options.device.or(device::named()))
        });
        let chosen = match chosen {
            Ok(chosen) => chosen,
            Err(error) => {
                // SAFETY: nothing else has been made from this instance.
                unsafe { instance.destroy_instance(None) };
                return Err(error);
            }
        };
        Self::open(entry, instance, &chosen, &wanted, messages, has_debug_utils, options)
            .with_context(|| format!("cannot open {}", chosen.name))
    }

    fn open(
        entry: Entry,
        instance: Instance,
        chosen: &Candidate,
        requirements: &Requirements,
        messages: Option<Arc<Messages>>,
        has_debug_utils: bool,
        options: &GpuOptions,
    ) -> Result<Self> {
        let software = chosen.kind == vk::PhysicalDeviceType::CPU;
        if software {
            threads::ensure_threads()?;
        }
        let physical_device = chosen.handle;
        let queue_family = chosen.queue_family.context("no compute queue")?;
        // Before the device, so that what is said of its creation counts.
        let messenger = match messages {
            Some(messages) => {
                let utils = ext::debug_utils::Instance::new(&entry, &instance);
                let info = messages.messenger_info();
                // SAFETY: the user data is kept beside the messenger.
                let handle = unsafe { utils.create_debug_utils_messenger(&info, None)? };
                Some((utils, handle, messages))
            }
            None => None,
        };
        let device = device::create(&instance, chosen, requirements)?;
        // SAFETY: the device was created with one queue of this family.
        let queue = unsafe { device.get_device_queue(queue_family, 0) };
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device,
            debug_settings: Default::default(),
            buffer_device_address: true,
            allocation_sizes: Default::default(),
        })?;
        // SAFETY: the physical device belongs to the live instance.
        let properties = unsafe { instance.get_physical_device_properties(physical_device) };
        let pool = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(queue_family);
        // SAFETY: the queue family belongs to this device.
        let command_pool = unsafe { device.create_command_pool(&pool, None)? };
        let debug = has_debug_utils
            .then(|| Debug { names: ext::debug_utils::Device::new(&instance, &device), messenger });
        Ok(Self(Arc::new(GpuContext {
            acceleration_structure: khr::acceleration_structure::Device::new(&instance, &device),
            ray_tracing_pipeline: khr::ray_tracing_pipeline::Device::new(&instance, &device),
            push_descriptor: khr::push_descriptor::Device::new(&instance, &device),
            executable_properties: requirements
                .extensions(&chosen.offered)
                .contains(&khr::pipeline_executable_properties::NAME)
                .then(|| khr::pipeline_executable_properties::Device::new(&instance, &device)),
            invocation_reorder: requirements
                .extensions(&chosen.offered)
                .contains(&nv::ray_tracing_invocation_reorder::NAME),
            limits: Limits::of(&instance, physical_device, queue_family),
            pipeline_cache: PipelineCache::open(&device, &properties),
            requirements: requirements.clone(),
            name: chosen.name.clone(),
            driver: chosen.driver.clone(),
            software,
            emulation: options.emulation.clone(),
            allocator: ManuallyDrop::new(Arc::new(Mutex::new(allocator))),
            statistics: Mutex::default(),
            command_pool: Mutex::new(command_pool),
            device,
            instance,
            entry,
            physical_device,
            queue,
            queue_family,
            debug,
        })))
    }

    /// Gives an object a name that validation messages and debuggers show.
    pub fn name_object<T: vk::Handle>(&self, handle: T, name: &str) {
        let Some(debug) = &self.debug else { return };
        let name = CString::new(name).unwrap_or_default();
        let info =
            vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the handle is alive and belongs to this device. A name that cannot be set is no
        // reason to stop.
        let _ = unsafe { debug.names.set_debug_utils_object_name(&info) };
    }

    /// What validation says, now and after the device is gone: a leak is said last.
    pub fn validation(&self) -> Arc<Messages> {
        let messenger = self.debug.as_ref().and_then(|debug| debug.messenger.as_ref());
        messenger.map_or_else(Arc::default, |(_, _, messages)| messages.clone())
    }

    /// What has been made so far, since [`Gpu::take_statistics`] if that was called.
    pub fn statistics(&self) -> Statistics {
        self.statistics.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What has been made since this was called last, for who asks as long as the program runs.
    pub fn take_statistics(&self) -> Statistics {
        let mut all = self.statistics.lock().unwrap_or_else(PoisonError::into_inner);
        let acceleration_structure_bytes = all.acceleration_structure_bytes;
        std::mem::replace(
            &mut all,
            Statistics { acceleration_structure_bytes, ..Statistics::default() },
        )
    }

    /// Adds to what has been made.
    pub(super) fn count(&self, add: impl FnOnce(&mut Statistics)) {
        add(&mut self.statistics.lock().unwrap_or_else(PoisonError::into_inner));
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
            if let Ok(pool) = self.command_pool.lock() {
                self.device.destroy_command_pool(*pool, None);
            }
            self.device.destroy_device(None);
            if let Some((utils, messenger, _)) = self.debug.take().and_then(|d| d.messenger) {
                utils.destroy_debug_utils_messenger(messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}
