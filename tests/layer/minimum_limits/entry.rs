//! The layer's entry points for the loader, and the lists of its own functions.

use std::ffi::{c_char, c_void};

use ash::vk;
use layer::Negotiation;

use crate::{commands, device, drawing, memory, physical, queues, rays};
use layer::below;

/// Negotiates version 2 of the interface, the current one.
///
/// # Safety
/// `negotiation` can be written.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn minimum_limits_negotiate(
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
        "vkCreateDevice" => device::create as *const c_void,
        "vkEnumerateDeviceExtensionProperties" => physical::extensions as *const c_void,
        "vkGetPhysicalDeviceProperties" => physical::properties as *const c_void,
        "vkGetPhysicalDeviceProperties2" | "vkGetPhysicalDeviceProperties2KHR" => {
            physical::properties2 as *const c_void
        }
        "vkGetPhysicalDeviceFeatures" => physical::features as *const c_void,
        "vkGetPhysicalDeviceFeatures2" | "vkGetPhysicalDeviceFeatures2KHR" => {
            physical::features2 as *const c_void
        }
        "vkGetPhysicalDeviceImageFormatProperties" => physical::image_format as *const c_void,
        "vkGetPhysicalDeviceQueueFamilyProperties" => queues::families as *const c_void,
        "vkGetPhysicalDeviceQueueFamilyProperties2"
        | "vkGetPhysicalDeviceQueueFamilyProperties2KHR" => queues::families2 as *const c_void,
        "vkGetPhysicalDeviceMemoryProperties" => memory::properties as *const c_void,
        "vkGetPhysicalDeviceMemoryProperties2" | "vkGetPhysicalDeviceMemoryProperties2KHR" => {
            memory::properties2 as *const c_void
        }
        "vkGetPhysicalDeviceSurfaceSupportKHR" => queues::surface_support as *const c_void,
        "vkGetPhysicalDeviceSurfaceCapabilitiesKHR" => {
            physical::surface_capabilities as *const c_void
        }
        _ => return device_function(name),
    })
}

/// The layer's function of this name, if it has one for devices and their objects.
fn device_function(name: &str) -> Option<*const c_void> {
    Some(match name {
        "vkGetDeviceProcAddr" => get_device_proc_addr as *const c_void,
        "vkDestroyDevice" => device::destroy as *const c_void,
        "vkGetDeviceQueue" => queues::queue as *const c_void,
        "vkGetDeviceQueue2" => queues::queue2 as *const c_void,
        "vkCreateCommandPool" => queues::create_command_pool as *const c_void,
        "vkQueueSubmit" => queues::submit as *const c_void,
        "vkQueueSubmit2" | "vkQueueSubmit2KHR" => queues::submit2 as *const c_void,
        "vkGetBufferMemoryRequirements" => memory::of_buffer as *const c_void,
        "vkGetBufferMemoryRequirements2" | "vkGetBufferMemoryRequirements2KHR" => {
            memory::of_buffer2 as *const c_void
        }
        "vkGetImageMemoryRequirements" => memory::of_image as *const c_void,
        "vkGetImageMemoryRequirements2" | "vkGetImageMemoryRequirements2KHR" => {
            memory::of_image2 as *const c_void
        }
        "vkAllocateMemory" => memory::allocate as *const c_void,
        "vkFreeMemory" => memory::free as *const c_void,
        "vkMapMemory" => memory::map as *const c_void,
        "vkCreateBuffer" => rays::create_buffer as *const c_void,
        "vkCmdPipelineBarrier2" | "vkCmdPipelineBarrier2KHR" => rays::barrier as *const c_void,
        "vkCreateAccelerationStructureKHR" => commands::create_structure as *const c_void,
        "vkCmdBuildAccelerationStructuresKHR" => commands::build as *const c_void,
        "vkCmdCopyAccelerationStructureKHR" => commands::copy_structure as *const c_void,
        "vkCmdTraceRaysKHR" => commands::trace as *const c_void,
        "vkCmdDispatch" => commands::dispatch as *const c_void,
        "vkCmdBeginRendering" | "vkCmdBeginRenderingKHR" => drawing::begin as *const c_void,
        "vkCmdDraw" => drawing::draw as *const c_void,
        "vkCmdFillBuffer" => commands::fill as *const c_void,
        "vkCmdUpdateBuffer" => commands::update as *const c_void,
        "vkCmdCopyBuffer" => commands::copy as *const c_void,
        "vkCmdCopyImageToBuffer" => commands::copy_from_image as *const c_void,
        "vkCmdClearColorImage" => commands::clear_image as *const c_void,
        "vkEndCommandBuffer" => commands::end as *const c_void,
        "vkCreateSwapchainKHR" => device::create_swapchain as *const c_void,
        _ => return None,
    })
}

unsafe extern "system" fn get_instance_proc_addr(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: names end in a zero byte, and the addresses are those of functions of Vulkan's convention.
    unsafe {
        let own = instance_function(layer::text(name));
        match own {
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
        let own = device_function(layer::text(name));
        match (own, below) {
            // If an extension is not enabled, the device has none of its functions.
            (Some(own), Some(_)) => layer::function(own),
            _ => below,
        }
    }
}
