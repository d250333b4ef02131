//! Functions below the layer, the next layer's or the driver's, for each instance and device.

use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk::Handle;
use ash::{khr, vk};

/// An instance's functions below the layer.
pub struct Instance {
    /// Vulkan's own.
    pub core: ash::Instance,
    /// `VK_KHR_surface`; its functions panic if the extension is not enabled.
    pub surface: khr::surface::InstanceFn,
    /// The function that looks up those the layer does not replace.
    pub get_proc_addr: vk::PFN_vkGetInstanceProcAddr,
}

/// A device's functions below the layer.
pub struct Device {
    /// Vulkan's own.
    pub core: ash::Device,
    /// `VK_KHR_swapchain`; its functions panic if the extension is not enabled.
    pub swapchain: khr::swapchain::DeviceFn,
    /// `VK_KHR_acceleration_structure`, in the same way.
    pub structures: khr::acceleration_structure::DeviceFn,
    /// `VK_KHR_ray_tracing_pipeline`, in the same way.
    pub rays: khr::ray_tracing_pipeline::DeviceFn,
    /// The function that looks up those the layer does not replace.
    pub get_proc_addr: vk::PFN_vkGetDeviceProcAddr,
    /// The device it was made from.
    pub physical: vk::PhysicalDevice,
}

static INSTANCES: Mutex<BTreeMap<usize, Arc<Instance>>> = Mutex::new(BTreeMap::new());
static DEVICES: Mutex<BTreeMap<usize, Arc<Device>>> = Mutex::new(BTreeMap::new());

/// The key shared by an instance and its physical devices, or by a device and its queues and command buffers:
/// the address of the loader's dispatch table, which is the first word of their objects.
fn key(handle: impl Handle) -> usize {
    // SAFETY: each of these handles points to an object that begins with that address.
    unsafe { *(handle.as_raw() as *const usize) }
}

/// The functions below an instance or one of its physical devices.
pub fn instance(handle: impl Handle) -> Arc<Instance> {
    let instances = INSTANCES.lock().unwrap_or_else(PoisonError::into_inner);
    instances.get(&key(handle)).expect("the instance was made through this layer").clone()
}

/// The functions below a device or one of its queues.
pub fn device(handle: impl Handle) -> Arc<Device> {
    let devices = DEVICES.lock().unwrap_or_else(PoisonError::into_inner);
    devices.get(&key(handle)).expect("the device was made through this layer").clone()
}

/// Stores the functions below a new instance.
pub fn add_instance(handle: vk::Instance, get_proc_addr: vk::PFN_vkGetInstanceProcAddr) {
    let load = |name: &CStr| {
        // SAFETY: the instance is alive, and the name ends in a zero byte.
        unsafe { address(get_proc_addr(handle, name.as_ptr())) }
    };
    let below = Instance {
        // SAFETY: the instance is alive.
        core: unsafe { ash::Instance::load_with(load, handle) },
        surface: khr::surface::InstanceFn::load(load),
        get_proc_addr,
    };
    INSTANCES.lock().unwrap_or_else(PoisonError::into_inner).insert(key(handle), Arc::new(below));
}

/// Stores the functions below a new device.
pub fn add_device(
    physical: vk::PhysicalDevice,
    handle: vk::Device,
    get_proc_addr: vk::PFN_vkGetDeviceProcAddr,
) {
    let load = |name: &CStr| {
        // SAFETY: the device is alive, and the name ends in a zero byte.
        unsafe { address(get_proc_addr(handle, name.as_ptr())) }
    };
    let below = Device {
        // SAFETY: the device is alive.
        core: unsafe { ash::Device::load_with(load, handle) },
        swapchain: khr::swapchain::DeviceFn::load(load),
        structures: khr::acceleration_structure::DeviceFn::load(load),
        rays: khr::ray_tracing_pipeline::DeviceFn::load(load),
        get_proc_addr,
        physical,
    };
    DEVICES.lock().unwrap_or_else(PoisonError::into_inner).insert(key(handle), Arc::new(below));
}

/// Removes an instance before its destruction, and returns the functions below it.
pub fn remove_instance(handle: vk::Instance) -> Option<Arc<Instance>> {
    INSTANCES.lock().unwrap_or_else(PoisonError::into_inner).remove(&key(handle))
}

/// Removes a device before its destruction, and returns the functions below it.
pub fn remove_device(handle: vk::Device) -> Option<Arc<Device>> {
    DEVICES.lock().unwrap_or_else(PoisonError::into_inner).remove(&key(handle))
}

/// A function's address, or null.
pub fn address(function: vk::PFN_vkVoidFunction) -> *const c_void {
    function.map_or(std::ptr::null(), |function| function as *const c_void)
}

/// A layer's `vkCreateInstance` that changes nothing and stores the functions below.
///
/// # Safety
/// As Vulkan's, here and below.
pub unsafe extern "system" fn create_instance(
    info: *const vk::InstanceCreateInfo,
    allocator: *const vk::AllocationCallbacks,
    instance: *mut vk::Instance,
) -> vk::Result {
    // SAFETY: the loader calls this once per instance, and the function below has that name.
    unsafe {
        match crate::create_instance(info, allocator, instance, |_, below| below) {
            Ok(get_proc_addr) => {
                add_instance(*instance, get_proc_addr);
                vk::Result::SUCCESS
            }
            Err(error) => error,
        }
    }
}

/// A layer's `vkDestroyInstance`.
///
/// # Safety
/// As Vulkan's.
pub unsafe extern "system" fn destroy_instance(
    instance: vk::Instance,
    allocator: *const vk::AllocationCallbacks,
) {
    if instance != vk::Instance::null()
        && let Some(below) = remove_instance(instance)
    {
        // SAFETY: the caller destroys an instance of its own.
        unsafe { (below.core.fp_v1_0().destroy_instance)(instance, allocator) };
    }
}
