//! The card: its apparent speed, and its compiler's statistics.

use ash::vk;
use layer::below;

use crate::{display, words};

/// # Safety
/// As Vulkan's, here and below.
pub unsafe extern "system" fn properties(
    physical: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceProperties,
) {
    // SAFETY: the arguments are the caller's.
    unsafe {
        let ask = below::instance(physical).core.fp_v1_0().get_physical_device_properties;
        ask(physical, properties);
        hasten(&mut *properties);
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
        hasten(&mut (*properties).properties);
    }
}

/// Shortens the period of the device's clock, so that the same number of ticks takes less time.
fn hasten(properties: &mut vk::PhysicalDeviceProperties) {
    if let Some(times) = words::value::<f32>("fast") {
        properties.limits.timestamp_period /= times;
        properties.device_type = vk::PhysicalDeviceType::DISCRETE_GPU;
    }
}

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
        let make = below::instance(physical).core.fp_v1_0().create_device;
        let result = make(physical, info, allocator, device);
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
    display::tell();
    if let Some(below) = below::remove_device(device) {
        // SAFETY: the caller destroys a device of its own.
        unsafe { (below.core.fp_v1_0().destroy_device)(device, allocator) };
    }
}

pub unsafe extern "system" fn figures(
    _: vk::Device,
    _: *const vk::PipelineInfoKHR,
    _: *mut u32,
    _: *mut vk::PipelineExecutablePropertiesKHR,
) -> vk::Result {
    vk::Result::ERROR_OUT_OF_HOST_MEMORY
}
