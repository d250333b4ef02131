//! A Vulkan driver for tests: its single device supports Vulkan 1.3 and no extensions.
//!
//! With `DRIVER_WITHOUT_DEVICE` in the environment it has no device, like an installed driver on a machine
//! without its hardware. It implements what the loader requires of a driver before any object is created:
//! <https://github.com/KhronosGroup/Vulkan-Loader/blob/main/docs/LoaderDriverInterface.md>.

use std::ffi::{CStr, c_char, c_void};

use ash::vk;

/// The value the loader expects at the start of an instance or a device, and replaces with its own.
const LOADER_MAGIC: usize = 0x01CD_C0DE;

/// Negotiates version 5 of the loader's interface, the first for Vulkan 1.1 and later.
///
/// # Safety
/// `version` can be written.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn vk_icdNegotiateLoaderICDInterfaceVersion(
    version: *mut u32,
) -> vk::Result {
    // SAFETY: the caller's promise.
    unsafe { *version = 5 };
    vk::Result::SUCCESS
}

/// The entry point of every driver.
///
/// # Safety
/// `name` is a string that ends in a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn vk_icdGetInstanceProcAddr(
    _: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the caller's promise.
    let name = unsafe { CStr::from_ptr(name) };
    let address = match name.to_str().unwrap_or_default() {
        "vkCreateInstance" => create_instance as *const c_void,
        "vkEnumeratePhysicalDevices" => enumerate_physical_devices as *const c_void,
        "vkGetPhysicalDeviceProperties" => properties as *const c_void,
        "vkGetPhysicalDeviceProperties2" => properties2 as *const c_void,
        "vkGetPhysicalDeviceQueueFamilyProperties" => queue_families as *const c_void,
        "vkEnumerateInstanceVersion" => instance_version as *const c_void,
        "vkEnumerateInstanceExtensionProperties" => no_instance_extensions as *const c_void,
        "vkEnumerateDeviceExtensionProperties" => no_device_extensions as *const c_void,
        "vkDestroyInstance"
        | "vkCreateDevice"
        | "vkGetDeviceProcAddr"
        | "vkGetPhysicalDeviceFeatures"
        | "vkGetPhysicalDeviceFeatures2"
        | "vkGetPhysicalDeviceFormatProperties"
        | "vkGetPhysicalDeviceImageFormatProperties"
        | "vkGetPhysicalDeviceMemoryProperties"
        | "vkGetPhysicalDeviceSparseImageFormatProperties" => nothing as *const c_void,
        _ => return None,
    };
    // SAFETY: each address is that of a function with Vulkan's calling convention.
    unsafe { std::mem::transmute::<*const c_void, vk::PFN_vkVoidFunction>(address) }
}

/// Writes nothing; returns success, or a null function.
extern "system" fn nothing() -> usize {
    0
}

/// # Safety
/// `version` can be written.
unsafe extern "system" fn instance_version(version: *mut u32) -> vk::Result {
    // SAFETY: the caller's promise.
    unsafe { *version = vk::API_VERSION_1_3 };
    vk::Result::SUCCESS
}

/// # Safety
/// `instance` can be written.
unsafe extern "system" fn create_instance(
    _: *const c_void,
    _: *const c_void,
    instance: *mut *mut usize,
) -> vk::Result {
    // SAFETY: the caller's promise. The leaked memory is small, and the test process is short.
    unsafe { *instance = Box::into_raw(Box::new(LOADER_MAGIC)) };
    vk::Result::SUCCESS
}

/// # Safety
/// `count` can be written, `devices` is null or has room for `count`.
unsafe extern "system" fn enumerate_physical_devices(
    _: vk::Instance,
    count: *mut u32,
    devices: *mut *mut usize,
) -> vk::Result {
    if std::env::var_os("DRIVER_WITHOUT_DEVICE").is_some() {
        return vk::Result::ERROR_INITIALIZATION_FAILED;
    }
    // SAFETY: the caller's promise.
    unsafe {
        *count = 1;
        if !devices.is_null() {
            *devices = Box::into_raw(Box::new(LOADER_MAGIC));
        }
    }
    vk::Result::SUCCESS
}

/// # Safety
/// `properties` can be written.
unsafe extern "system" fn properties(
    _: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceProperties,
) {
    let described = vk::PhysicalDeviceProperties {
        api_version: vk::API_VERSION_1_3,
        device_type: vk::PhysicalDeviceType::DISCRETE_GPU,
        ..Default::default()
    };
    // SAFETY: the caller's promise.
    unsafe { *properties = described.device_name(c"A card of 2014").expect("the name is short") };
}

/// # Safety
/// `properties2` heads a chain of structures that can be written.
unsafe extern "system" fn properties2(
    device: vk::PhysicalDevice,
    properties2: *mut vk::PhysicalDeviceProperties2,
) {
    // SAFETY: the caller's promise; the type of a structure is in its first field.
    unsafe {
        properties(device, &raw mut (*properties2).properties);
        let mut next = (*properties2).p_next.cast::<vk::BaseOutStructure>();
        while !next.is_null() {
            if (*next).s_type == vk::StructureType::PHYSICAL_DEVICE_DRIVER_PROPERTIES {
                let driver = &mut *next.cast::<vk::PhysicalDeviceDriverProperties>();
                let named = driver.driver_name(c"A driver").expect("the name is short");
                *driver = named.driver_info(c"1.0").expect("the text is short");
            }
            next = (*next).p_next;
        }
    }
}

/// # Safety
/// `count` can be written, `families` is null or has room for `count`.
unsafe extern "system" fn queue_families(
    _: vk::PhysicalDevice,
    count: *mut u32,
    families: *mut vk::QueueFamilyProperties,
) {
    let flags = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    // SAFETY: the caller's promise.
    unsafe {
        *count = 1;
        if !families.is_null() {
            *families = vk::QueueFamilyProperties::default().queue_flags(flags).queue_count(1);
        }
    }
}

/// # Safety
/// `count` can be written.
unsafe extern "system" fn no_instance_extensions(
    _: *const c_char,
    count: *mut u32,
    _: *mut vk::ExtensionProperties,
) -> vk::Result {
    // SAFETY: the caller's promise.
    unsafe { *count = 0 };
    vk::Result::SUCCESS
}

/// # Safety
/// `count` can be written.
unsafe extern "system" fn no_device_extensions(
    _: vk::PhysicalDevice,
    layer: *const c_char,
    count: *mut u32,
    properties: *mut vk::ExtensionProperties,
) -> vk::Result {
    // SAFETY: the caller's promise.
    unsafe { no_instance_extensions(layer, count, properties) }
}
