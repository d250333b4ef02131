//! A device made and destroyed, and its swapchain.

use std::ffi::c_void;

use ash::vk;

use crate::entry::LINK;
use crate::{below, faults, memory, queues};

/// `VkLayerDeviceCreateInfo`, as far as the layer reads it.
#[repr(C)]
struct DeviceLink {
    kind: vk::StructureType,
    next: *const c_void,
    function: u32,
    link: *mut NextDevice,
}

/// `VkLayerDeviceLink`.
#[repr(C)]
struct NextDevice {
    next: *mut NextDevice,
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    get_device_proc_addr: vk::PFN_vkGetDeviceProcAddr,
}

pub unsafe extern "system" fn create(
    physical: vk::PhysicalDevice,
    info: *const vk::DeviceCreateInfo,
    allocator: *const vk::AllocationCallbacks,
    device: *mut vk::Device,
) -> vk::Result {
    // SAFETY: the loader puts its structure, which may be written, in the chain of every layer.
    unsafe {
        let mut at = (*info).p_next.cast_mut().cast::<DeviceLink>();
        while !at.is_null()
            && ((*at).kind, (*at).function) != (vk::StructureType::LOADER_DEVICE_CREATE_INFO, LINK)
        {
            at = (*at).next.cast_mut().cast();
        }
        let Some(found) = at.as_mut() else { return vk::Result::ERROR_INITIALIZATION_FAILED };
        let get_proc_addr = (*found.link).get_device_proc_addr;
        // The next layer finds its own link here.
        found.link = (*found.link).next;
        // However many families are asked for, the one below serves them all.
        let family = queues::family_below(physical);
        let asked = (*info).p_queue_create_infos;
        let asked = std::slice::from_raw_parts(asked, (*info).queue_create_info_count as usize);
        let Some(first) = asked.first() else { return vk::Result::ERROR_INITIALIZATION_FAILED };
        let queue =
            vk::DeviceQueueCreateInfo { queue_family_index: family, queue_count: 1, ..*first };
        let narrow = vk::DeviceCreateInfo {
            queue_create_info_count: 1,
            p_queue_create_infos: &raw const queue,
            ..*info
        };
        let create = below::instance(physical).core.fp_v1_0().create_device;
        let result = create(physical, &raw const narrow, allocator, device);
        if result == vk::Result::SUCCESS {
            below::add_device(physical, *device, get_proc_addr);
        }
        result
    }
}

pub unsafe extern "system" fn destroy(
    device: vk::Device,
    allocator: *const vk::AllocationCallbacks,
) {
    if device == vk::Device::null() {
        return;
    }
    memory::forget_all();
    faults::tell();
    if let Some(below) = below::remove_device(device) {
        // SAFETY: the caller destroys a device of its own.
        unsafe { (below.core.fp_v1_0().destroy_device)(device, allocator) };
    }
}

pub unsafe extern "system" fn create_swapchain(
    device: vk::Device,
    info: *const vk::SwapchainCreateInfoKHR,
    allocator: *const vk::AllocationCallbacks,
    swapchain: *mut vk::SwapchainKHR,
) -> vk::Result {
    if faults::first_swapchain_is_out_of_date() {
        return vk::Result::ERROR_OUT_OF_DATE_KHR;
    }
    // SAFETY: the arguments are the caller's.
    unsafe {
        (below::device(device).swapchain.create_swapchain_khr)(device, info, allocator, swapchain)
    }
}
