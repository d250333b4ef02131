//! The layer's entry points for the loader, and the lists of its own functions.

use std::ffi::{c_char, c_void};

use ash::vk;
use layer::{Negotiation, below};

use crate::{card, display, words};

/// Negotiates version 2 of the interface, the current one.
///
/// # Safety
/// `negotiation` can be written.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn display_faults_negotiate(
    negotiation: *mut Negotiation,
) -> vk::Result {
    // SAFETY: the caller's promise.
    unsafe { (*negotiation).settle(get_instance_proc_addr, get_device_proc_addr) }
}

/// The layer's function of this name, if it has one for instances and physical devices.
fn instance_function(name: &str) -> Option<*const c_void> {
    Some(match name {
        "vkGetInstanceProcAddr" => get_instance_proc_addr as *const c_void,
        "vkCreateInstance" => below::create_instance as *const c_void,
        "vkDestroyInstance" => below::destroy_instance as *const c_void,
        "vkCreateDevice" => card::create as *const c_void,
        "vkGetPhysicalDeviceProperties" => card::properties as *const c_void,
        "vkGetPhysicalDeviceProperties2" | "vkGetPhysicalDeviceProperties2KHR" => {
            card::properties2 as *const c_void
        }
        "vkGetPhysicalDeviceSurfaceCapabilitiesKHR" => display::capabilities as *const c_void,
        "vkGetPhysicalDeviceSurfaceFormatsKHR" => display::formats as *const c_void,
        _ => return device_function(name),
    })
}

/// The layer's function of this name, if it has one for devices and their objects.
fn device_function(name: &str) -> Option<*const c_void> {
    Some(match name {
        "vkGetDeviceProcAddr" => get_device_proc_addr as *const c_void,
        "vkDestroyDevice" => card::destroy as *const c_void,
        "vkCreateSwapchainKHR" => display::create_swapchain as *const c_void,
        "vkAcquireNextImageKHR" => display::acquire as *const c_void,
        "vkQueuePresentKHR" => display::present as *const c_void,
        "vkGetPipelineExecutablePropertiesKHR" if words::has("no-figures") => {
            card::figures as *const c_void
        }
        _ => return None,
    })
}

unsafe extern "system" fn get_instance_proc_addr(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: names end in a zero byte, and the addresses are those of functions of Vulkan's convention.
    unsafe {
        match instance_function(layer::text(name)) {
            Some(own) => layer::function(own),
            None if instance == vk::Instance::null() => None,
            None => (below::instance(instance).get_proc_addr)(instance, name),
        }
    }
}

unsafe extern "system" fn get_device_proc_addr(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: as above.
    unsafe {
        let below = (below::device(device).get_proc_addr)(device, name);
        match (device_function(layer::text(name)), below) {
            // If an extension is not enabled, the device has none of its functions.
            (Some(own), Some(_)) => layer::function(own),
            _ => below,
        }
    }
}
