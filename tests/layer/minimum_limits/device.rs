//! Creates and destroys a device and its swapchain.

use std::ffi::CStr;

use ash::{khr, vk};

use crate::{faults, memory, physical, queues};
use layer::below;

pub unsafe extern "system" fn create(
    physical: vk::PhysicalDevice,
    info: *const vk::DeviceCreateInfo,
    allocator: *const vk::AllocationCallbacks,
    device: *mut vk::Device,
) -> vk::Result {
    // SAFETY: the loader calls this once per device; the other arguments are the caller's.
    unsafe {
        let Some(get_proc_addr) = layer::below_device(info) else {
            return vk::Result::ERROR_INITIALIZATION_FAILED;
        };
        let Ok(shown) = physical::shown(physical) else {
            return vk::Result::ERROR_INITIALIZATION_FAILED;
        };
        let names = (*info).pp_enabled_extension_names;
        let count = (*info).enabled_extension_count as usize;
        let mut names: Vec<_> = (0..count).map(|at| CStr::from_ptr(*names.add(at))).collect();
        let is_shown =
            |name: &&CStr| shown.iter().any(|e| e.extension_name_as_c_str() == Ok(*name));
        if !names.iter().all(is_shown) {
            return vk::Result::ERROR_EXTENSION_NOT_PRESENT;
        }
        // The device below does not know what this layer adds.
        names.retain(|name| *name != khr::portability_subset::NAME);
        let names: Vec<_> = names.iter().map(|name| name.as_ptr()).collect();
        // One family below serves all requested ones.
        let family = queues::family_below(physical);
        let asked = (*info).p_queue_create_infos;
        let asked = std::slice::from_raw_parts(asked, (*info).queue_create_info_count as usize);
        let Some(first) = asked.first() else { return vk::Result::ERROR_INITIALIZATION_FAILED };
        let queue =
            vk::DeviceQueueCreateInfo { queue_family_index: family, queue_count: 1, ..*first };
        let narrow = vk::DeviceCreateInfo {
            queue_create_info_count: 1,
            p_queue_create_infos: &raw const queue,
            enabled_extension_count: names.len() as u32,
            pp_enabled_extension_names: names.as_ptr(),
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
