//! A Vulkan layer for tests: makes a chosen call fail.
//!
//! - `FAIL=vkQueueSubmit2:3:-4`: the third call of that function does nothing and returns that `VkResult`;
//!   with `3+`, every call from the third on; with a file's path, the next call after the file was made.
//!   `vkMapMemory:1:0` succeeds, and gives `MAP_FAILED`, as a driver may where address space is short.
//! - `FAIL=vkCmdCopyImageToBuffer`: each such copy is made twice, with nothing between.
//! - `CALLS=FILE`: when the instance is destroyed, one line per function that may fail and was called is
//!   written to the file: its name, and the number of calls.
//!
//! Functions that cannot fail, and those that need no instance, are not counted.

mod calls;
mod twice;

use std::ffi::{c_char, c_void};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use ash::vk::{self, Handle};
use layer::Negotiation;

/// The layer's name in its manifest.
pub const NAME: &str = "VK_LAYER_TESTS_failing";

/// `vkGetInstanceProcAddr` and `vkGetDeviceProcAddr` of the next layer or the driver. A sample has one
/// instance and one device at a time.
static BELOW_INSTANCE: Mutex<Option<vk::PFN_vkGetInstanceProcAddr>> = Mutex::new(None);
static BELOW_DEVICE: Mutex<Option<vk::PFN_vkGetDeviceProcAddr>> = Mutex::new(None);
static INSTANCE: AtomicU64 = AtomicU64::new(0);
/// `vkDestroyInstance` of the same, looked up early: a layer below may have removed the instance by then.
static DESTROY_INSTANCE: Mutex<Option<vk::PFN_vkDestroyInstance>> = Mutex::new(None);

/// Exchanges the functions that look up others.
///
/// # Safety
/// `negotiation` can be written.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn fail_nth_call_negotiate(negotiation: *mut Negotiation) -> vk::Result {
    // SAFETY: the caller's promise.
    unsafe { (*negotiation).settle(of_instance, of_device) }
}

unsafe extern "system" fn of_instance(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: names end in a zero byte, and the addresses are those of functions of Vulkan's convention.
    unsafe {
        let own = match layer::text(name) {
            "vkGetInstanceProcAddr" => of_instance as *const c_void,
            "vkGetDeviceProcAddr" => of_device as *const c_void,
            "vkCreateInstance" => create_instance as *const c_void,
            "vkCreateDevice" => create_device as *const c_void,
            "vkDestroyInstance" => destroy_instance as *const c_void,
            _ => {
                let next = *BELOW_INSTANCE.lock().unwrap_or_else(PoisonError::into_inner);
                return next.and_then(|next| calls::over(name, next(instance, name)));
            }
        };
        layer::function(own)
    }
}

unsafe extern "system" fn of_device(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: as above.
    unsafe {
        if layer::text(name) == "vkGetDeviceProcAddr" {
            return layer::function(of_device as *const c_void);
        }
        let next = *BELOW_DEVICE.lock().unwrap_or_else(PoisonError::into_inner);
        let below = next.and_then(|next| next(device, name));
        match layer::text(name) {
            twice::NAME => twice::over(below),
            _ => calls::over(name, below),
        }
    }
}

unsafe extern "system" fn create_instance(
    info: *const vk::InstanceCreateInfo,
    allocator: *const vk::AllocationCallbacks,
    instance: *mut vk::Instance,
) -> vk::Result {
    // SAFETY: the loader calls this once per instance, and the function below has that name.
    unsafe {
        let over = |name, below| calls::over(name, below);
        let next = match layer::create_instance(info, allocator, instance, over) {
            Ok(next) => next,
            Err(error) => return error,
        };
        *BELOW_INSTANCE.lock().unwrap_or_else(PoisonError::into_inner) = Some(next);
        INSTANCE.store((*instance).as_raw(), Ordering::Relaxed);
        let destroy = next(*instance, c"vkDestroyInstance".as_ptr());
        *DESTROY_INSTANCE.lock().unwrap_or_else(PoisonError::into_inner) = std::mem::transmute::<
            vk::PFN_vkVoidFunction,
            Option<vk::PFN_vkDestroyInstance>,
        >(destroy);
    }
    vk::Result::SUCCESS
}

unsafe extern "system" fn create_device(
    physical: vk::PhysicalDevice,
    info: *const vk::DeviceCreateInfo,
    allocator: *const vk::AllocationCallbacks,
    device: *mut vk::Device,
) -> vk::Result {
    // SAFETY: as above.
    unsafe {
        let instance = INSTANCE.load(Ordering::Relaxed);
        let next = *BELOW_INSTANCE.lock().unwrap_or_else(PoisonError::into_inner);
        let (Some(next), Some(below)) = (next, layer::below_device(info)) else {
            return vk::Result::ERROR_INITIALIZATION_FAILED;
        };
        *BELOW_DEVICE.lock().unwrap_or_else(PoisonError::into_inner) = Some(below);
        let name = c"vkCreateDevice".as_ptr();
        let create = calls::over(name, next(vk::Instance::from_raw(instance), name));
        std::mem::transmute::<vk::PFN_vkVoidFunction, vk::PFN_vkCreateDevice>(create)(
            physical, info, allocator, device,
        )
    }
}

unsafe extern "system" fn destroy_instance(
    instance: vk::Instance,
    allocator: *const vk::AllocationCallbacks,
) {
    calls::tell();
    let destroy = *DESTROY_INSTANCE.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(destroy) = destroy {
        // SAFETY: the caller destroys an instance of its own.
        unsafe { destroy(instance, allocator) };
    }
}
