//! The interface between the loader and a Vulkan layer:
//! <https://github.com/KhronosGroup/Vulkan-Loader/blob/main/docs/LoaderLayerInterface.md>.

pub mod below;

use std::ffi::{CStr, c_char, c_void};

use ash::vk;

/// `VkNegotiateLayerInterface`.
#[repr(C)]
pub struct Negotiation {
    kind: u32,
    next: *mut c_void,
    version: u32,
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    get_device_proc_addr: vk::PFN_vkGetDeviceProcAddr,
    get_physical_device_proc_addr: Option<vk::PFN_vkGetInstanceProcAddr>,
}

impl Negotiation {
    /// Negotiates version 2 of the interface, the current one, and exchanges the functions that look up
    /// others.
    pub fn settle(
        &mut self,
        get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
        get_device_proc_addr: vk::PFN_vkGetDeviceProcAddr,
    ) -> vk::Result {
        self.version = 2;
        self.get_instance_proc_addr = get_instance_proc_addr;
        self.get_device_proc_addr = get_device_proc_addr;
        self.get_physical_device_proc_addr = None;
        vk::Result::SUCCESS
    }
}

/// The part of `VkLayerInstanceCreateInfo` and `VkLayerDeviceCreateInfo` that a layer reads.
#[repr(C)]
struct Link<T> {
    kind: vk::StructureType,
    next: *const c_void,
    function: u32,
    below: *mut T,
}

/// `VK_LAYER_LINK_INFO`.
const LINK: u32 = 0;

/// `VkLayerInstanceLink`.
#[repr(C)]
struct BelowInstance {
    next: *mut BelowInstance,
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    get_physical_device_proc_addr: Option<vk::PFN_vkGetInstanceProcAddr>,
}

/// `VkLayerDeviceLink`.
#[repr(C)]
struct BelowDevice {
    next: *mut BelowDevice,
    get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    get_device_proc_addr: vk::PFN_vkGetDeviceProcAddr,
}

/// Creates an instance with the `vkCreateInstance` below, which `over` may replace; returns the function that
/// looks up those below the instance.
///
/// # Errors
/// If there is nothing below, or the function below fails.
///
/// # Safety
/// The arguments are the loader's own, and `over` returns a function of that name.
pub unsafe fn create_instance(
    info: *const vk::InstanceCreateInfo,
    allocator: *const vk::AllocationCallbacks,
    instance: *mut vk::Instance,
    over: impl FnOnce(*const c_char, vk::PFN_vkVoidFunction) -> vk::PFN_vkVoidFunction,
) -> Result<vk::PFN_vkGetInstanceProcAddr, vk::Result> {
    let name = c"vkCreateInstance".as_ptr();
    // SAFETY: the caller's promise; the loader finds its own functions by name.
    unsafe {
        let next = below_instance(info).ok_or(vk::Result::ERROR_INITIALIZATION_FAILED)?;
        let create = over(name, next(vk::Instance::null(), name));
        let create =
            std::mem::transmute::<vk::PFN_vkVoidFunction, vk::PFN_vkCreateInstance>(create);
        create(info, allocator, instance).result()?;
        Ok(next)
    }
}

/// The lookup of functions below an instance that is being created; the next layer looks up its own.
///
/// # Safety
/// `info` comes from the loader, once per instance.
unsafe fn below_instance(
    info: *const vk::InstanceCreateInfo,
) -> Option<vk::PFN_vkGetInstanceProcAddr> {
    // SAFETY: the loader puts its structure, which may be written, in the chain of every layer.
    unsafe {
        let link = link((*info).p_next, vk::StructureType::LOADER_INSTANCE_CREATE_INFO)?;
        let below: &BelowInstance = &*link.below;
        link.below = below.next;
        Some(below.get_instance_proc_addr)
    }
}

/// As [`below_instance`], for a device.
///
/// # Safety
/// As for [`below_instance`].
pub unsafe fn below_device(
    info: *const vk::DeviceCreateInfo,
) -> Option<vk::PFN_vkGetDeviceProcAddr> {
    // SAFETY: as above.
    unsafe {
        let link = link((*info).p_next, vk::StructureType::LOADER_DEVICE_CREATE_INFO)?;
        let below: &BelowDevice = &*link.below;
        link.below = below.next;
        Some(below.get_device_proc_addr)
    }
}

/// # Safety
/// `chain` is the loader's, and `kind` matches `T`.
unsafe fn link<T>(chain: *const c_void, kind: vk::StructureType) -> Option<&'static mut Link<T>> {
    let mut at = chain.cast_mut().cast::<Link<T>>();
    // SAFETY: every structure of a chain begins with its type and a pointer to the next; only the loader's
    // contains a function.
    unsafe {
        while let Some(found) = at.as_mut() {
            if found.kind == kind && found.function == LINK {
                return Some(found);
            }
            at = found.next.cast_mut().cast();
        }
    }
    None
}

/// A function's name; empty if it is not valid text.
///
/// # Safety
/// `name` ends in a zero byte and outlives the result.
pub unsafe fn text<'a>(name: *const c_char) -> &'a str {
    // SAFETY: the caller's promise.
    unsafe { CStr::from_ptr(name) }.to_str().unwrap_or_default()
}

/// A function in Vulkan's form.
///
/// # Safety
/// The address is that of a function with Vulkan's calling convention.
pub unsafe fn function(address: *const c_void) -> vk::PFN_vkVoidFunction {
    // SAFETY: the caller's promise; a null pointer becomes `None`.
    unsafe { std::mem::transmute::<*const c_void, vk::PFN_vkVoidFunction>(address) }
}
