//! The choice of a physical device: real GPUs first, and for each one refused, what it lacks.

use std::ffi::CStr;
use std::sync::LazyLock;

use anyhow::{Context, Result, bail, ensure};
use ash::{Device, Entry, Instance, khr, vk};

use super::instance::{self, WindowHandles};
use super::limits::Limits;
use super::{Features, Requirements};
use crate::usage::Usage;

/// A physical device, described well enough to choose it or to say why not.
pub struct Candidate {
    /// The Vulkan handle.
    pub handle: vk::PhysicalDevice,
    /// Its position in Vulkan's enumeration, which `--device N` names.
    pub index: usize,
    /// Its name, as the driver gives it.
    pub name: String,
    /// The driver's name and version in its maker's words.
    pub driver: String,
    /// Discrete, integrated, virtual or CPU.
    pub kind: vk::PhysicalDeviceType,
    /// A queue family with compute (and so with ray tracing), graphics where there is one.
    pub queue_family: Option<u32>,
    /// Whether that family has graphics.
    pub graphics: bool,
    /// The features that it has.
    pub offered: Features,
    /// What this device lacks for the sample at hand; empty if it will do.
    pub missing: Vec<String>,
}

impl Candidate {
    /// One line: number, name, kind, driver, and whether it will do.
    pub fn line(&self) -> String {
        let verdict = match self.missing.as_slice() {
            [] => "suitable".to_owned(),
            missing => format!("lacks {}", missing.join(", ")),
        };
        format!("{}: {} ({}; {}): {verdict}", self.index, self.name, kind(self.kind), self.driver)
    }
}

fn kind(device_type: vk::PhysicalDeviceType) -> &'static str {
    match device_type {
        vk::PhysicalDeviceType::DISCRETE_GPU => "discrete GPU",
        vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated GPU",
        vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual GPU",
        vk::PhysicalDeviceType::CPU => "software",
        _ => "other",
    }
}

/// Every device of the instance, judged against what the sample asks for.
///
/// # Errors
/// If Vulkan cannot enumerate devices.
pub fn candidates(instance: &Instance, wanted: &Requirements) -> Result<Vec<Candidate>> {
    // SAFETY: the instance is alive.
    let handles = match unsafe { instance.enumerate_physical_devices() } {
        // What loaders say where drivers are installed, but none of them finds its device.
        Err(vk::Result::ERROR_INITIALIZATION_FAILED) => Vec::new(),
        handles => handles.context("cannot list the Vulkan devices")?,
    };
    handles
        .into_iter()
        .enumerate()
        .map(|(index, handle)| judge(instance, index, handle, wanted))
        .collect()
}

fn judge(
    instance: &Instance,
    index: usize,
    handle: vk::PhysicalDevice,
    wanted: &Requirements,
) -> Result<Candidate> {
    // SAFETY: handle belongs to the live instance, here and below.
    let properties = unsafe { instance.get_physical_device_properties(handle) };
    let text = |name: Result<&CStr, _>| {
        name.map_or_else(|_| String::new(), |n| n.to_string_lossy().into())
    };
    let mut candidate = Candidate {
        handle,
        index,
        name: text(properties.device_name_as_c_str()),
        driver: String::new(),
        kind: properties.device_type,
        queue_family: None,
        graphics: false,
        offered: Features::default(),
        missing: Vec::new(),
    };
    let version = properties.api_version;
    if version < vk::API_VERSION_1_3 {
        let (major, minor) = (vk::api_version_major(version), vk::api_version_minor(version));
        candidate.driver = format!("Vulkan {major}.{minor}");
        candidate.missing.push("Vulkan 1.3".to_owned());
        return Ok(candidate);
    }

    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut more = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    // SAFETY: as above; driver properties are core since Vulkan 1.2.
    unsafe { instance.get_physical_device_properties2(handle, &mut more) };
    let (name, info) = (text(driver.driver_name_as_c_str()), text(driver.driver_info_as_c_str()));
    candidate.driver = format!("{name} {info}");

    // SAFETY: as above.
    let extensions = unsafe { instance.enumerate_device_extension_properties(handle)? };
    let has = |name: &CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(name));
    let mut offered = Features::default();
    offered.with_chain(has, |features| {
        // SAFETY: the chain holds only structures of core 1.3 and of extensions that the device has.
        unsafe { instance.get_physical_device_features2(handle, features) }
    });
    candidate.offered = offered;

    // SAFETY: as above.
    let families = unsafe { instance.get_physical_device_queue_family_properties(handle) };
    let family =
        |flags| families.iter().position(|f| f.queue_flags.contains(flags)).map(|i| i as u32);
    // The window's panel needs graphics; a headless run does with compute, as data-centre GPUs have it.
    let graphics = family(vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE);
    candidate.graphics = graphics.is_some();
    candidate.queue_family = graphics.or_else(|| family(vk::QueueFlags::COMPUTE));
    let carried = [khr::acceleration_structure::NAME, khr::ray_tracing_pipeline::NAME];
    let limits = candidate
        .queue_family
        .filter(|_| carried.iter().all(|name| has(name)))
        .map(|family| Limits::of(instance, handle, family));
    candidate.missing = wanted.missing(has, &offered, limits.as_ref());
    if candidate.queue_family.is_none() {
        candidate.missing.push("a compute queue".to_owned());
    }
    if wanted.raster {
        // SAFETY: as above.
        let depth = unsafe {
            instance.get_physical_device_format_properties(handle, vk::Format::D32_SFLOAT)
        };
        let drawn = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
        let needed = [
            ("a queue with graphics", candidate.graphics),
            ("depth in D32_SFLOAT", depth.optimal_tiling_features.contains(drawn)),
        ];
        let lacking = needed.iter().filter(|(_, has)| !has);
        candidate.missing.extend(lacking.map(|(what, _)| (*what).to_owned()));
    }
    Ok(candidate)
}

const INSTALL: &str =
    "run ./setup to install a software driver with ray tracing, or update your GPU's driver";

/// Fails if there is no device at all.
///
/// # Errors
/// Then, with what to install.
pub fn ensure_some(candidates: &[Candidate]) -> Result<()> {
    ensure!(!candidates.is_empty(), "no Vulkan device, though there is a driver: {INSTALL}");
    Ok(())
}

/// Adds to what each device lacks a queue that can draw and present to a window.
///
/// # Errors
/// If the window takes no Vulkan surface.
pub fn require_presentation(
    entry: &Entry,
    instance: &Instance,
    window: &WindowHandles,
    candidates: &mut [Candidate],
) -> Result<()> {
    let surfaces = khr::surface::Instance::new(entry, instance);
    // SAFETY: the window outlives this call, at whose end the surface is destroyed.
    unsafe {
        let surface =
            ash_window::create_surface(entry, instance, window.display, window.window, None)?;
        for candidate in candidates {
            let Some(family) = candidate.queue_family else { continue };
            let presents =
                surfaces.get_physical_device_surface_support(candidate.handle, family, surface);
            if !candidate.graphics || !presents.unwrap_or(false) {
                candidate.missing.push("a queue that draws to this window".to_owned());
                continue;
            }
            // Pictures are copied to the window's images, which a device must let them be drawn to alone.
            let usage = surfaces
                .get_physical_device_surface_capabilities(candidate.handle, surface)
                .map(|capabilities| capabilities.supported_usage_flags);
            if usage.is_ok_and(|usage| !usage.contains(vk::ImageUsageFlags::TRANSFER_DST)) {
                candidate.missing.push("copies to this window's images (TRANSFER_DST)".to_owned());
            }
        }
        surfaces.destroy_surface(surface, None);
    }
    Ok(())
}

/// A part of a device's name that `GPU` in the environment asks for, as `--device` does; `GPU=1`, with which
/// tests ask for the best device, names none.
pub fn named() -> Option<&'static str> {
    static NAMED: LazyLock<Option<String>> =
        LazyLock::new(|| std::env::var("GPU").ok().filter(|gpu| !["", "0", "1"].contains(&&**gpu)));
    NAMED.as_deref()
}

/// Picks the device that `asked` names by number or part of its name, else the best suitable one.
///
/// # Errors
/// If none fits: one line that lists every device and what it lacks, and what to install.
pub fn choose(candidates: Vec<Candidate>, asked: Option<&str>) -> Result<Candidate> {
    let list = |all: &[Candidate]| all.iter().map(Candidate::line).collect::<Vec<_>>().join(" · ");
    ensure_some(&candidates)?;
    if let Some(asked) = asked {
        let matches = |candidate: &Candidate| match asked.parse::<usize>() {
            Ok(number) => candidate.index == number,
            Err(_) => candidate.name.to_lowercase().contains(&asked.to_lowercase()),
        };
        let Some(position) = candidates.iter().position(matches) else {
            return Err(
                Usage(format!("no device '{asked}'; there is {}", list(&candidates))).into()
            );
        };
        if !candidates[position].missing.is_empty() {
            bail!("device '{asked}' cannot run this: {}", list(&candidates[position..=position]));
        }
        return Ok(candidates.into_iter().nth(position).expect("the position was just found"));
    }
    let rank = |candidate: &Candidate| match candidate.kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => 0,
        vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
        vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
        vk::PhysicalDeviceType::CPU => 4,
        _ => 3,
    };
    let explained = list(&candidates);
    let suitable = candidates.into_iter().filter(|candidate| candidate.missing.is_empty());
    match suitable.min_by_key(rank) {
        Some(best) => Ok(best),
        None => bail!("no device can run this: {explained}; {INSTALL}"),
    }
}

/// One line a device: what it is, and what it lacks for `wanted`.
///
/// # Errors
/// If there is no Vulkan.
pub fn device_lines(wanted: &Requirements) -> Result<Vec<String>> {
    let entry = instance::load()?;
    let (instance, _) = instance::create(&entry, None, None)?;
    let found = candidates(&instance, wanted);
    // SAFETY: nothing has been made from this instance.
    unsafe { instance.destroy_instance(None) };
    let found = found?;
    ensure_some(&found)?;
    Ok(found.iter().map(Candidate::line).collect())
}

/// Opens a device with one queue, and with just the features and extensions that are asked for.
///
/// # Errors
/// If the device cannot be opened.
pub fn create(
    instance: &Instance,
    chosen: &Candidate,
    requirements: &Requirements,
) -> Result<Device> {
    let priorities = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(chosen.queue_family.context("no compute queue")?)
        .queue_priorities(&priorities)];
    let extensions = requirements.extensions(&chosen.offered);
    let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    let device = requirements.features(&chosen.offered).with_chain(
        |name| extensions.contains(&name),
        |features| {
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .enabled_extension_names(&names)
                .push_next(features);
            // SAFETY: the device offers these features and extensions: `candidates` has checked.
            unsafe { instance.create_device(chosen.handle, &info, None) }
        },
    );
    Ok(device?)
}

#[cfg(test)]
mod tests;
