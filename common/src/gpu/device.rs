//! The choice of a physical device: real GPUs first, and the missing features of each one refused.

pub(crate) mod chained;
pub mod context;
pub mod features;
pub mod instance;
pub mod limits;
mod newer;
pub mod requirements;
pub mod threads;

use std::ffi::CStr;
use std::sync::LazyLock;

use anyhow::{Context as _, Result, bail, ensure};
use ash::{Device, Instance, khr, vk};

use super::{Features, Requirements};
use crate::UsageError;
use crate::gpu::device::instance::{Vulkan, WindowHandles};
use crate::gpu::device::limits::Limits;

/// A physical device, with everything needed to choose it, to explain why not, and to open it.
#[derive(Default)]
pub struct Candidate {
    /// The Vulkan handle.
    pub physical_device: vk::PhysicalDevice,
    /// Its position in Vulkan's enumeration, for `--device N`.
    pub index: usize,
    /// Its name, from the driver.
    pub name: String,
    /// The driver's name and version, in its maker's words.
    pub driver: String,
    /// True for a driver that runs on the CPU.
    pub software: bool,
    /// Its version, kind and identity.
    pub properties: vk::PhysicalDeviceProperties,
    /// The limits that ray tracing code must respect.
    pub limits: Limits,
    /// The family of a queue with compute (and so with ray tracing), and with graphics if possible.
    pub queue_family: u32,
    /// True if that family has graphics.
    pub graphics: bool,
    /// The features to enable: the required ones, and the optional ones the device supports.
    pub features: Features,
    /// The extensions to enable.
    pub extensions: Vec<&'static CStr>,
    /// The features this device lacks for the sample; empty if it is suitable.
    pub missing: Vec<String>,
}

impl Candidate {
    /// One line: number, name, kind, driver, and whether it is suitable.
    pub fn line(&self) -> String {
        let verdict = match self.missing.as_slice() {
            [] => "suitable".to_owned(),
            missing => format!("lacks {}", missing.join(", ")),
        };
        let kind = KINDS[self.rank()].1;
        format!("{}: {} ({kind}; {}): {verdict}", self.index, self.name, self.driver)
    }

    /// The position of its kind among [`KINDS`].
    fn rank(&self) -> usize {
        let kind = self.properties.device_type;
        KINDS.iter().position(|(known, _)| *known == kind).unwrap_or(OTHER)
    }
}

/// Kinds of devices, the best first.
const KINDS: [(vk::PhysicalDeviceType, &str); 5] = [
    (vk::PhysicalDeviceType::DISCRETE_GPU, "discrete GPU"),
    (vk::PhysicalDeviceType::INTEGRATED_GPU, "integrated GPU"),
    (vk::PhysicalDeviceType::VIRTUAL_GPU, "virtual GPU"),
    (vk::PhysicalDeviceType::OTHER, "other"),
    (vk::PhysicalDeviceType::CPU, "software"),
];
const OTHER: usize = 3;

/// Every device of the instance, compared with the requirements.
///
/// # Errors
/// If Vulkan cannot enumerate devices.
pub fn candidates(instance: &Instance, wanted: &Requirements) -> Result<Vec<Candidate>> {
    // SAFETY: the instance is alive.
    let handles = match unsafe { instance.enumerate_physical_devices() } {
        // Loaders return this if drivers are installed, but none of them finds its device.
        Err(vk::Result::ERROR_INITIALIZATION_FAILED) => Vec::new(),
        handles => handles.context("cannot list the Vulkan devices")?,
    };
    let handles = handles.into_iter().enumerate();
    handles.map(|(index, handle)| judge(instance, index, handle, wanted)).collect()
}

fn judge(
    instance: &Instance,
    index: usize,
    physical_device: vk::PhysicalDevice,
    wanted: &Requirements,
) -> Result<Candidate> {
    // SAFETY: the physical device belongs to the live instance, here and below.
    let properties = unsafe { instance.get_physical_device_properties(physical_device) };
    let name = properties.device_name_as_c_str().unwrap_or_default().to_string_lossy();
    let mut candidate = Candidate {
        physical_device,
        index,
        name: name.into_owned(),
        software: properties.device_type == vk::PhysicalDeviceType::CPU,
        properties,
        queue_family: vk::QUEUE_FAMILY_IGNORED,
        ..Candidate::default()
    };
    let version = properties.api_version;
    if version < vk::API_VERSION_1_3 {
        let (major, minor) = (vk::api_version_major(version), vk::api_version_minor(version));
        candidate.driver = format!("Vulkan {major}.{minor}");
        candidate.missing.push("Vulkan 1.3".to_owned());
        return Ok(candidate);
    }

    // SAFETY: as above.
    let extensions = unsafe { instance.enumerate_device_extension_properties(physical_device)? };
    let has = |name: &CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(name));
    let mut limits = Limits::of(instance, physical_device, has);
    let driver = [limits.vulkan12.driver_name_as_c_str(), limits.vulkan12.driver_info_as_c_str()];
    candidate.driver = driver.map(|text| text.unwrap_or_default().to_string_lossy()).join(" ");
    let mut offered = Features::default();
    let mut chain = offered.chain(has);
    // SAFETY: the chain holds only structures of core 1.3 and of extensions that the device has.
    unsafe { instance.get_physical_device_features2(physical_device, &mut chain) };
    offered.core = chain.features;
    candidate.features = wanted.features(&offered);
    candidate.extensions = wanted.extensions(&offered);
    // An incomplete implementation, as on Macs, requires programs to enable this extension
    // (VUID-VkDeviceCreateInfo-pProperties-04451). Nothing that it may lack is used here.
    if has(khr::portability_subset::NAME) {
        candidate.extensions.push(khr::portability_subset::NAME);
    }

    // SAFETY: as above.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical_device) };
    let family = |flags| families.iter().position(|family| family.queue_flags.contains(flags));
    // The window's panel needs graphics; for a headless run compute is enough, as on data-centre GPUs.
    let graphics = family(vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE);
    candidate.graphics = graphics.is_some();
    let queue = graphics.or_else(|| family(vk::QueueFlags::COMPUTE));
    if let Some(family) = queue {
        candidate.queue_family = family as u32;
        limits.timestamp_bits = families[family].timestamp_valid_bits;
    }
    candidate.missing = wanted.missing(has, &offered, queue.is_some().then_some(&limits));
    candidate.limits = limits;
    if queue.is_none() {
        candidate.missing.push("a compute queue".to_owned());
    }
    if (wanted.raster || wanted.mipmaps) && !candidate.graphics {
        candidate.missing.push("a queue with graphics".to_owned());
    }
    if wanted.raster {
        // SAFETY: as above.
        let depth = unsafe {
            instance.get_physical_device_format_properties(physical_device, vk::Format::D32_SFLOAT)
        };
        let drawn = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
        if !depth.optimal_tiling_features.contains(drawn) {
            candidate.missing.push("depth in D32_SFLOAT".to_owned());
        }
    }
    Ok(candidate)
}

const INSTALL: &str =
    "run ./setup to install a software driver with ray tracing, or update your GPU's driver";

/// Fails if there is no device at all.
///
/// # Errors
/// States what to install.
pub fn ensure_some(candidates: &[Candidate]) -> Result<()> {
    ensure!(!candidates.is_empty(), "no Vulkan device, though there is a driver: {INSTALL}");
    Ok(())
}

/// Adds to the missing features of each device a queue for presenting in the window, if it lacks one.
///
/// # Errors
/// If the window does not support Vulkan surfaces.
pub fn require_presentation(
    Vulkan { entry, instance, .. }: &Vulkan,
    window: &WindowHandles,
    candidates: &mut [Candidate],
) -> Result<()> {
    let surfaces = khr::surface::Instance::new(entry, instance);
    // SAFETY: the window outlives this call, at whose end the surface is destroyed.
    unsafe {
        let surface =
            ash_window::create_surface(entry, instance, window.display, window.window, None)?;
        for candidate in candidates {
            let (device, family) = (candidate.physical_device, candidate.queue_family);
            if family == vk::QUEUE_FAMILY_IGNORED {
                continue;
            }
            let presents = surfaces.get_physical_device_surface_support(device, family, surface);
            if !candidate.graphics || !presents.unwrap_or(false) {
                candidate.missing.push("a queue that draws to this window".to_owned());
                continue;
            }
            // Pictures are copied to the window's images, a usage that a device need not support.
            let usage = surfaces
                .get_physical_device_surface_capabilities(device, surface)
                .map(|capabilities| capabilities.supported_usage_flags);
            if usage.is_ok_and(|usage| !usage.contains(vk::ImageUsageFlags::TRANSFER_DST)) {
                candidate.missing.push("copies to this window's images (TRANSFER_DST)".to_owned());
            }
        }
        surfaces.destroy_surface(surface, None);
    }
    Ok(())
}

/// The part of a device's name in the environment variable `GPU`, an alternative to `--device`; `None` for
/// `GPU=1`, with which tests select the best device.
pub fn named() -> Option<&'static str> {
    static NAMED: LazyLock<Option<String>> =
        LazyLock::new(|| std::env::var("GPU").ok().filter(|gpu| !["", "0", "1"].contains(&&**gpu)));
    NAMED.as_deref()
}

/// Picks the device selected by number or part of its name, else the best suitable one.
///
/// # Errors
/// If none fits: one line that lists every device with its missing features, and what to install.
pub fn choose(mut candidates: Vec<Candidate>, asked: Option<&str>) -> Result<Candidate> {
    let list = |all: &[Candidate]| all.iter().map(Candidate::line).collect::<Vec<_>>().join(" · ");
    ensure_some(&candidates)?;
    let Some(asked) = asked else {
        let suitable = (0..candidates.len()).filter(|&at| candidates[at].missing.is_empty());
        return match suitable.min_by_key(|&at| candidates[at].rank()) {
            Some(best) => Ok(candidates.swap_remove(best)),
            None => bail!("no device can run this: {}; {INSTALL}", list(&candidates)),
        };
    };
    let matches = |candidate: &Candidate| match asked.parse::<usize>() {
        Ok(number) => candidate.index == number,
        Err(_) => candidate.name.to_lowercase().contains(&asked.to_lowercase()),
    };
    let Some(position) = candidates.iter().position(matches) else {
        return Err(
            UsageError(format!("no device '{asked}'; there is {}", list(&candidates))).into()
        );
    };
    if !candidates[position].missing.is_empty() {
        bail!("device '{asked}' cannot run this: {}", list(&candidates[position..=position]));
    }
    Ok(candidates.swap_remove(position))
}

/// One line per device: its description, and the features missing from `wanted`.
///
/// # Errors
/// If there is no Vulkan.
pub fn device_lines(wanted: &Requirements) -> Result<Vec<String>> {
    let found = candidates(&Vulkan::new(None, None)?.instance, wanted)?;
    ensure_some(&found)?;
    Ok(found.iter().map(Candidate::line).collect())
}

/// Opens a device with one queue and only the selected features and extensions.
///
/// # Errors
/// If the device cannot be opened.
pub fn create(instance: &Instance, chosen: &Candidate) -> Result<Device> {
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(chosen.queue_family)
        .queue_priorities(&[1.0])];
    let names: Vec<_> = chosen.extensions.iter().map(|name| name.as_ptr()).collect();
    let mut features = chosen.features;
    let mut features = features.chain(|name| chosen.extensions.contains(&name));
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&names)
        .push_next(&mut features);
    // SAFETY: the device offers these features and extensions: `judge` has checked.
    Ok(unsafe { instance.create_device(chosen.physical_device, &info, None) }?)
}

#[cfg(test)]
mod tests;
