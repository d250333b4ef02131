//! Queries about the device: its properties, features, extensions and surfaces.

use std::ffi::{CStr, c_char, c_void};

use ash::{khr, vk};

use crate::{faults, features, limits};
use layer::below;

/// All extensions the samples use; the device has no others.
const EXTENSIONS: [&CStr; 2] = [khr::push_descriptor::NAME, khr::swapchain::NAME];

/// The extensions of samples that trace rays.
const RAY_TRACING: [&CStr; 3] = [
    khr::acceleration_structure::NAME,
    khr::deferred_host_operations::NAME,
    khr::ray_tracing_pipeline::NAME,
];

/// The extensions of samples that trace without a pipeline, or fetch positions: a narrow device may lack
/// them.
const QUERIES: [&CStr; 2] = [khr::ray_query::NAME, khr::ray_tracing_position_fetch::NAME];

/// The extensions the device reports.
pub fn shown(physical: vk::PhysicalDevice) -> Result<Vec<vk::ExtensionProperties>, vk::Result> {
    let below = below::instance(physical);
    // SAFETY: the physical device is alive.
    let all = unsafe { below.core.enumerate_device_extension_properties(physical)? };
    let is_shown = |name: &CStr| {
        EXTENSIONS.contains(&name)
            || RAY_TRACING.contains(&name) && !faults::has("no-ray-tracing")
            || QUERIES.contains(&name) && faults::has("queries")
    };
    let mut shown = all;
    shown.retain(|own| own.extension_name_as_c_str().is_ok_and(is_shown));
    if faults::has("portability") {
        let name = khr::portability_subset::NAME;
        let own = vk::ExtensionProperties::default().spec_version(1).extension_name(name);
        shown.push(own.expect("the name is short"));
    }
    Ok(shown)
}

/// # Safety
/// As Vulkan's, here and below.
pub unsafe extern "system" fn extensions(
    physical: vk::PhysicalDevice,
    layer: *const c_char,
    count: *mut u32,
    properties: *mut vk::ExtensionProperties,
) -> vk::Result {
    let below = below::instance(physical);
    // SAFETY: the arguments are the caller's; `properties` is null or has room for `count`.
    unsafe {
        if !layer.is_null() {
            let ask = below.core.fp_v1_0().enumerate_device_extension_properties;
            return ask(physical, layer, count, properties);
        }
        let shown = match shown(physical) {
            Ok(shown) => shown,
            Err(error) => return error,
        };
        if properties.is_null() {
            *count = shown.len() as u32;
            return vk::Result::SUCCESS;
        }
        let is_all = *count as usize >= shown.len();
        *count = (*count).min(shown.len() as u32);
        properties.copy_from_nonoverlapping(shown.as_ptr(), *count as usize);
        if is_all { vk::Result::SUCCESS } else { vk::Result::INCOMPLETE }
    }
}

pub unsafe extern "system" fn properties(
    physical: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceProperties,
) {
    // SAFETY: as above.
    unsafe {
        let ask = below::instance(physical).core.fp_v1_0().get_physical_device_properties;
        ask(physical, properties);
        limits::core(&mut *properties);
    }
}

pub unsafe extern "system" fn properties2(
    physical: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceProperties2,
) {
    // SAFETY: as above; the type of a structure identifies it.
    unsafe {
        let ask = below::instance(physical).core.fp_v1_1().get_physical_device_properties2;
        without_hidden(properties.cast(), || {
            ask(physical, properties);
            limits::core(&mut (*properties).properties);
            each((*properties).p_next, |link| limits::narrow(link));
        });
    }
}

pub unsafe extern "system" fn features(
    _: vk::PhysicalDevice,
    features: *mut vk::PhysicalDeviceFeatures,
) {
    // SAFETY: as above.
    unsafe { *features = features::core() };
}

pub unsafe extern "system" fn features2(
    physical: vk::PhysicalDevice,
    features: *mut vk::PhysicalDeviceFeatures2,
) {
    // SAFETY: as above.
    unsafe {
        let ask = below::instance(physical).core.fp_v1_1().get_physical_device_features2;
        without_hidden(features.cast(), || {
            ask(physical, features);
            (*features).features = features::core();
            each((*features).p_next, |link| features::narrow(link));
        });
    }
}

/// Calls `f` with the structures of hidden extensions removed from a chain, because a device does not fill
/// those.
unsafe fn without_hidden(head: *mut vk::BaseOutStructure, f: impl FnOnce()) {
    let (mut at, mut hidden) = (head, Vec::new());
    // SAFETY: the chain is the caller's and ends in null; each structure is put back in its place.
    unsafe {
        while let Some(next) = (*at).p_next.as_mut() {
            if faults::has("no-ray-tracing") && is_of_rays(next.s_type) {
                hidden.push((at, (*at).p_next));
                (*at).p_next = next.p_next;
            } else {
                at = next;
            }
        }
        f();
        for (before, link) in hidden.into_iter().rev() {
            (*before).p_next = link;
        }
    }
}

/// Returns whether a structure belongs to a ray tracing extension.
fn is_of_rays(kind: vk::StructureType) -> bool {
    use vk::StructureType as Type;
    [
        Type::PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
        Type::PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR,
        Type::PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR,
        Type::PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR,
        Type::PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR,
        Type::PHYSICAL_DEVICE_RAY_TRACING_POSITION_FETCH_FEATURES_KHR,
        Type::PHYSICAL_DEVICE_RAY_TRACING_MAINTENANCE_1_FEATURES_KHR,
        Type::PHYSICAL_DEVICE_OPACITY_MICROMAP_FEATURES_EXT,
        Type::PHYSICAL_DEVICE_OPACITY_MICROMAP_PROPERTIES_EXT,
    ]
    .contains(&kind)
}

/// Calls `f` with every structure of a chain.
unsafe fn each(chain: *mut c_void, f: impl Fn(*mut vk::BaseOutStructure)) {
    let mut at = chain.cast::<vk::BaseOutStructure>();
    while !at.is_null() {
        f(at);
        // SAFETY: the chain is the caller's, and ends in null.
        at = unsafe { (*at).p_next };
    }
}

pub unsafe extern "system" fn image_format(
    physical: vk::PhysicalDevice,
    format: vk::Format,
    kind: vk::ImageType,
    tiling: vk::ImageTiling,
    usage: vk::ImageUsageFlags,
    flags: vk::ImageCreateFlags,
    properties: *mut vk::ImageFormatProperties,
) -> vk::Result {
    // SAFETY: as above.
    unsafe {
        let ask =
            below::instance(physical).core.fp_v1_0().get_physical_device_image_format_properties;
        let result = ask(physical, format, kind, tiling, usage, flags, properties);
        let most = &mut (*properties).max_extent;
        most.width = most.width.min(limits::IMAGE_SIDE);
        most.height = most.height.min(limits::IMAGE_SIDE);
        result
    }
}

pub unsafe extern "system" fn surface_capabilities(
    physical: vk::PhysicalDevice,
    surface: vk::SurfaceKHR,
    capabilities: *mut vk::SurfaceCapabilitiesKHR,
) -> vk::Result {
    // SAFETY: as above.
    unsafe {
        let ask = below::instance(physical).surface.get_physical_device_surface_capabilities_khr;
        let result = ask(physical, surface, capabilities);
        // The specification only promises drawing to it.
        if faults::has("no-transfer-dst") {
            (*capabilities).supported_usage_flags = vk::ImageUsageFlags::COLOR_ATTACHMENT;
        }
        result
    }
}
