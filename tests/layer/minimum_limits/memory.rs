//! Memory as on a discrete card: the host cannot map the device's fast memory, and the device is slow with
//! the host's.

use std::collections::BTreeMap;
use std::ffi::c_void;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError};

use ash::vk;
use ash::vk::Handle;

use crate::{faults, limits};
use layer::below;

/// The type that only the device accesses.
const DEVICE: u32 = 0;
/// The type that the host maps.
const HOST: u32 = 1;
/// With `bar`: the type in device memory that the host can map.
const BOTH: u32 = 2;
/// The size of each heap, unless the variable sets it. The specification promises no size.
const HEAP: u64 = 1 << 30;

/// The allocations that count against the device's heap, with type and size.
static ALLOCATED: Mutex<BTreeMap<u64, (u32, u64)>> = Mutex::new(BTreeMap::new());
/// The number of allocations of each type.
static COUNTS: [AtomicU32; 3] = [const { AtomicU32::new(0) }; 3];

fn heap() -> u64 {
    faults::value("heap").map_or(HEAP, |bytes| bytes.parse().expect("heap= is followed by bytes"))
}

/// The types below that implement those shown.
fn types_below(physical: vk::PhysicalDevice) -> [u32; 3] {
    // SAFETY: the physical device is alive.
    let all =
        unsafe { below::instance(physical).core.get_physical_device_memory_properties(physical) };
    let mapped = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
    let wanted = [vk::MemoryPropertyFlags::DEVICE_LOCAL, mapped, mapped];
    wanted.map(|flags| {
        let types = all.memory_types_as_slice();
        let found = types.iter().position(|own| own.property_flags.contains(flags));
        found.expect("Vulkan promises a type of each kind") as u32
    })
}

fn shown() -> vk::PhysicalDeviceMemoryProperties {
    let mut shown = vk::PhysicalDeviceMemoryProperties {
        memory_type_count: if faults::has("bar") { 3 } else { 2 },
        memory_heap_count: 2,
        ..Default::default()
    };
    shown.memory_heaps[0] =
        vk::MemoryHeap { size: heap(), flags: vk::MemoryHeapFlags::DEVICE_LOCAL };
    shown.memory_heaps[1] = vk::MemoryHeap { size: HEAP, flags: vk::MemoryHeapFlags::empty() };
    shown.memory_types[DEVICE as usize] =
        vk::MemoryType { property_flags: vk::MemoryPropertyFlags::DEVICE_LOCAL, heap_index: 0 };
    shown.memory_types[HOST as usize] = vk::MemoryType {
        property_flags: vk::MemoryPropertyFlags::HOST_VISIBLE
            | vk::MemoryPropertyFlags::HOST_COHERENT,
        heap_index: 1,
    };
    shown.memory_types[BOTH as usize] = vk::MemoryType {
        property_flags: vk::MemoryPropertyFlags::DEVICE_LOCAL
            | shown.memory_types[HOST as usize].property_flags,
        heap_index: 0,
    };
    shown
}

/// Reduces a buffer's alignment to one that a driver may use.
fn loosen(requirements: &mut vk::MemoryRequirements) {
    if faults::has("loose-buffers") {
        requirements.alignment = limits::LOOSE;
    }
}

/// Converts the memory types of a resource from those below to those shown.
fn narrow(device: vk::Device, requirements: &mut vk::MemoryRequirements) {
    let types = types_below(below::device(device).physical);
    let bits = requirements.memory_type_bits;
    let suits = |&own: &u32| bits & 1 << types[own as usize] != 0;
    requirements.memory_type_bits =
        (0..shown().memory_type_count).filter(suits).map(|own| 1 << own).sum();
}

/// # Safety
/// As Vulkan's, here and below.
pub unsafe extern "system" fn properties(
    _: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceMemoryProperties,
) {
    // SAFETY: the caller's structure can be written.
    unsafe { *properties = shown() };
}

pub unsafe extern "system" fn properties2(
    _: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceMemoryProperties2,
) {
    // SAFETY: as above.
    unsafe { (*properties).memory_properties = shown() };
}

pub unsafe extern "system" fn of_buffer(
    device: vk::Device,
    buffer: vk::Buffer,
    requirements: *mut vk::MemoryRequirements,
) {
    // SAFETY: the arguments are the caller's, here and below.
    unsafe {
        let ask = below::device(device).core.fp_v1_0().get_buffer_memory_requirements;
        ask(device, buffer, requirements);
        narrow(device, &mut *requirements);
        loosen(&mut *requirements);
    }
}

pub unsafe extern "system" fn of_buffer2(
    device: vk::Device,
    info: *const vk::BufferMemoryRequirementsInfo2,
    requirements: *mut vk::MemoryRequirements2,
) {
    // SAFETY: as above.
    unsafe {
        let ask = below::device(device).core.fp_v1_1().get_buffer_memory_requirements2;
        ask(device, info, requirements);
        narrow(device, &mut (*requirements).memory_requirements);
        loosen(&mut (*requirements).memory_requirements);
    }
}

pub unsafe extern "system" fn of_image(
    device: vk::Device,
    image: vk::Image,
    requirements: *mut vk::MemoryRequirements,
) {
    // SAFETY: as above.
    unsafe {
        let ask = below::device(device).core.fp_v1_0().get_image_memory_requirements;
        ask(device, image, requirements);
        narrow(device, &mut *requirements);
    }
}

pub unsafe extern "system" fn of_image2(
    device: vk::Device,
    info: *const vk::ImageMemoryRequirementsInfo2,
    requirements: *mut vk::MemoryRequirements2,
) {
    // SAFETY: as above.
    unsafe {
        let ask = below::device(device).core.fp_v1_1().get_image_memory_requirements2;
        ask(device, info, requirements);
        narrow(device, &mut (*requirements).memory_requirements);
    }
}

pub unsafe extern "system" fn allocate(
    device: vk::Device,
    info: *const vk::MemoryAllocateInfo,
    allocator: *const vk::AllocationCallbacks,
    memory: *mut vk::DeviceMemory,
) -> vk::Result {
    let below = below::device(device);
    // SAFETY: as above.
    unsafe {
        let own = (*info).memory_type_index;
        let mut allocated = ALLOCATED.lock().unwrap_or_else(PoisonError::into_inner);
        let size = (*info).allocation_size;
        let is_on_device = own != HOST;
        COUNTS[own as usize].fetch_add(1, Ordering::Relaxed);
        let in_use: u64 = allocated.values().map(|(_, size)| size).sum();
        if is_on_device && in_use + size > heap() {
            return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
        }
        let memory_type_index = types_below(below.physical)[own as usize];
        let info = vk::MemoryAllocateInfo { memory_type_index, ..*info };
        let allocate = below.core.fp_v1_0().allocate_memory;
        let result = allocate(device, &raw const info, allocator, memory);
        if is_on_device && result == vk::Result::SUCCESS {
            allocated.insert((*memory).as_raw(), (own, size));
        }
        result
    }
}

pub unsafe extern "system" fn free(
    device: vk::Device,
    memory: vk::DeviceMemory,
    allocator: *const vk::AllocationCallbacks,
) {
    ALLOCATED.lock().unwrap_or_else(PoisonError::into_inner).remove(&memory.as_raw());
    // SAFETY: as above.
    unsafe { (below::device(device).core.fp_v1_0().free_memory)(device, memory, allocator) };
}

pub unsafe extern "system" fn map(
    device: vk::Device,
    memory: vk::DeviceMemory,
    offset: vk::DeviceSize,
    size: vk::DeviceSize,
    flags: vk::MemoryMapFlags,
    data: *mut *mut c_void,
) -> vk::Result {
    let allocated = ALLOCATED.lock().unwrap_or_else(PoisonError::into_inner);
    // Undefined if the host cannot see it; the driver below would map it, because its host sees everything.
    if allocated.get(&memory.as_raw()).is_some_and(|(own, _)| *own == DEVICE) {
        return vk::Result::ERROR_MEMORY_MAP_FAILED;
    }
    let map = below::device(device).core.fp_v1_0().map_memory;
    // SAFETY: as above.
    unsafe { map(device, memory, offset, size, flags, data) }
}

/// The number of allocations: in memory that the host cannot map, in host memory, and in both.
pub fn counts() -> [u32; 3] {
    COUNTS.each_ref().map(|count| count.load(Ordering::Relaxed))
}

/// Removes the allocations of a device at its destruction.
pub fn forget_all() {
    ALLOCATED.lock().unwrap_or_else(PoisonError::into_inner).clear();
}
