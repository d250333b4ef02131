//! The layer's entry points for the loader, and its own functions.

use std::ffi::{c_char, c_void};

use ash::vk;
use layer::{Negotiation, below};

use crate::{builds, create, device, physical};

/// Negotiates version 2 of the interface, the current one.
///
/// # Safety
/// `negotiation` can be written.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn micromaps_negotiate(negotiation: *mut Negotiation) -> vk::Result {
    // SAFETY: the caller's promise.
    unsafe { (*negotiation).settle(get_instance_proc_addr, get_device_proc_addr) }
}

unsafe extern "system" fn get_instance_proc_addr(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: names end in a zero byte, and the addresses are those of functions of Vulkan's convention.
    unsafe {
        let own = match layer::text(name) {
            "vkGetInstanceProcAddr" => get_instance_proc_addr as *const c_void,
            "vkGetDeviceProcAddr" => get_device_proc_addr as *const c_void,
            "vkCreateInstance" => below::create_instance as *const c_void,
            "vkDestroyInstance" => below::destroy_instance as *const c_void,
            "vkCreateDevice" => device::create as *const c_void,
            "vkEnumerateDeviceExtensionProperties" => physical::extensions as *const c_void,
            "vkGetPhysicalDeviceProperties2" => physical::properties2 as *const c_void,
            "vkGetPhysicalDeviceFeatures2" => physical::features2 as *const c_void,
            // An instance extension, whose functions loaders and layers below look up here.
            "vkSetDebugUtilsObjectNameEXT" => device::name_object as *const c_void,
            _ if instance == vk::Instance::null() => return None,
            _ => return (below::instance(instance).get_proc_addr)(instance, name),
        };
        layer::function(own)
    }
}

unsafe extern "system" fn get_device_proc_addr(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: as above.
    unsafe {
        let below = (below::device(device).get_proc_addr)(device, name);
        let own = match layer::text(name) {
            // A driver below may lack it.
            "vkCreateAccelerationStructure2KHR" => {
                return layer::function(create::create2 as *const c_void);
            }
            "vkSetDebugUtilsObjectNameEXT" => device::name_object as *const c_void,
            "vkGetDeviceProcAddr" => get_device_proc_addr as *const c_void,
            "vkDestroyDevice" => device::destroy as *const c_void,
            "vkCreateAccelerationStructureKHR" => create::create as *const c_void,
            "vkDestroyAccelerationStructureKHR" => create::destroy as *const c_void,
            "vkGetAccelerationStructureBuildSizesKHR" => create::sizes as *const c_void,
            "vkCmdBuildAccelerationStructuresKHR" => builds::build as *const c_void,
            "vkCreateRayTracingPipelinesKHR" => device::create_pipelines as *const c_void,
            _ => return below,
        };
        // If an extension is not enabled, the device has none of its functions.
        below.and_then(|_| layer::function(own))
    }
}
