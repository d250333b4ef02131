//! Queries about the device: both extensions, their features and limits.

use std::ffi::{CStr, c_char, c_void};

use ash::vk;
use layer::below;

use crate::record::finest;
use crate::structures::{ADDRESS_COMMANDS_FEATURES, FEATURES, Feature, PROPERTIES, Properties};

/// The extensions added by the layer, unless a driver below supports them.
pub const EXTENSIONS: [&CStr; 2] = [c"VK_KHR_device_address_commands", c"VK_KHR_opacity_micromap"];

/// The extensions of the device below.
///
/// # Errors
/// As in Vulkan.
///
/// # Safety
/// The device is alive.
pub unsafe fn below_extensions(
    physical: vk::PhysicalDevice,
) -> Result<Vec<vk::ExtensionProperties>, vk::Result> {
    // SAFETY: the caller's promise.
    unsafe { below::instance(physical).core.enumerate_device_extension_properties(physical) }
}

pub fn has(all: &[vk::ExtensionProperties], name: &CStr) -> bool {
    all.iter().any(|one| one.extension_name_as_c_str() == Ok(name))
}

/// # Safety
/// As Vulkan's, here and below.
pub unsafe extern "system" fn extensions(
    physical: vk::PhysicalDevice,
    layer: *const c_char,
    count: *mut u32,
    properties: *mut vk::ExtensionProperties,
) -> vk::Result {
    // SAFETY: the arguments are the caller's; `properties` is null or has room for `count`.
    unsafe {
        if !layer.is_null() {
            let ask =
                below::instance(physical).core.fp_v1_0().enumerate_device_extension_properties;
            return ask(physical, layer, count, properties);
        }
        let mut all = match below_extensions(physical) {
            Ok(all) => all,
            Err(error) => return error,
        };
        for name in EXTENSIONS.into_iter().filter(|name| !has(&all, name)).collect::<Vec<_>>() {
            let own = vk::ExtensionProperties::default().spec_version(1);
            all.push(own.extension_name(name).expect("a short name"));
        }
        if properties.is_null() {
            *count = all.len() as u32;
            return vk::Result::SUCCESS;
        }
        let is_all = *count as usize >= all.len();
        *count = (*count).min(all.len() as u32);
        properties.copy_from_nonoverlapping(all.as_ptr(), *count as usize);
        if is_all { vk::Result::SUCCESS } else { vk::Result::INCOMPLETE }
    }
}

pub unsafe extern "system" fn features2(
    physical: vk::PhysicalDevice,
    features: *mut vk::PhysicalDeviceFeatures2,
) {
    // SAFETY: as above; the type of a structure identifies it.
    unsafe {
        let ask = below::instance(physical).core.fp_v1_1().get_physical_device_features2;
        ask(physical, features);
        each((*features).p_next, |kind, link| {
            if matches!(kind, FEATURES | ADDRESS_COMMANDS_FEATURES) {
                (*link.cast::<Feature>()).on = vk::TRUE;
            }
        });
    }
}

pub unsafe extern "system" fn properties2(
    physical: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceProperties2,
) {
    // SAFETY: as above.
    unsafe {
        let ask = below::instance(physical).core.fp_v1_1().get_physical_device_properties2;
        ask(physical, properties);
        each((*properties).p_next, |kind, link| {
            if kind == PROPERTIES {
                let own = &mut *link.cast::<Properties>();
                (own.two_state_level, own.four_state_level) = (finest(), finest());
                (own.lossy_level, own.triangles) = (finest(), 1 << 27);
            }
        });
    }
}

/// Calls `f` with the type and the address of every structure of a chain.
///
/// # Safety
/// The chain ends in null.
pub unsafe fn each(chain: *mut c_void, mut f: impl FnMut(i32, *mut c_void)) {
    let mut at = chain.cast::<vk::BaseOutStructure>();
    while !at.is_null() {
        // SAFETY: the caller's promise.
        unsafe {
            f((*at).s_type.as_raw(), at.cast());
            at = (*at).p_next;
        }
    }
}
