//! Queue families: the one below appears as several, of which some cannot trace.

use std::sync::atomic::{AtomicU32, Ordering};

use ash::vk;

use crate::faults;
use layer::below;

static SUBMITS: AtomicU32 = AtomicU32::new(0);

/// The families the device shows: one that only copies, one that computes, and one with graphics, because one
/// family must have both if any has graphics (chapter "Devices and Queues"). The transfer bit is implied and
/// therefore left out, as the specification allows. None has timestamps.
fn shown() -> Vec<vk::QueueFamilyProperties> {
    let family = |flags| {
        vk::QueueFamilyProperties::default()
            .queue_flags(flags)
            .queue_count(1)
            .timestamp_valid_bits(0)
            .min_image_transfer_granularity(vk::Extent3D { width: 1, height: 1, depth: 1 })
    };
    let mut families = vec![family(vk::QueueFlags::TRANSFER), family(vk::QueueFlags::COMPUTE)];
    // A queue that only copies may be limited to whole images.
    families[0].min_image_transfer_granularity = vk::Extent3D::default();
    if !faults::has("compute-only") {
        families.push(family(vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE));
    }
    families
}

/// The family below that does all the work.
pub fn family_below(physical: vk::PhysicalDevice) -> u32 {
    // SAFETY: the physical device is alive.
    let families = unsafe {
        below::instance(physical).core.get_physical_device_queue_family_properties(physical)
    };
    let with = |flags| families.iter().position(|family| family.queue_flags.contains(flags));
    with(vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE)
        .or_else(|| with(vk::QueueFlags::COMPUTE))
        .unwrap_or(0) as u32
}

/// # Safety
/// As Vulkan's, here and below.
pub unsafe extern "system" fn families(
    _: vk::PhysicalDevice,
    count: *mut u32,
    families: *mut vk::QueueFamilyProperties,
) {
    let shown = shown();
    // SAFETY: `families` is null or has room for `count`.
    unsafe {
        if families.is_null() {
            *count = shown.len() as u32;
            return;
        }
        *count = (*count).min(shown.len() as u32);
        families.copy_from_nonoverlapping(shown.as_ptr(), *count as usize);
    }
}

pub unsafe extern "system" fn families2(
    _: vk::PhysicalDevice,
    count: *mut u32,
    families: *mut vk::QueueFamilyProperties2,
) {
    let shown = shown();
    // SAFETY: as above.
    unsafe {
        if families.is_null() {
            *count = shown.len() as u32;
            return;
        }
        *count = (*count).min(shown.len() as u32);
        for (at, family) in shown.into_iter().take(*count as usize).enumerate() {
            (*families.add(at)).queue_family_properties = family;
        }
    }
}

pub unsafe extern "system" fn surface_support(
    physical: vk::PhysicalDevice,
    family: u32,
    surface: vk::SurfaceKHR,
    supported: *mut vk::Bool32,
) -> vk::Result {
    let draws = shown()[family as usize].queue_flags.contains(vk::QueueFlags::GRAPHICS);
    let below = below::instance(physical);
    // SAFETY: the arguments are the caller's.
    unsafe {
        let ask = below.surface.get_physical_device_surface_support_khr;
        let result = ask(physical, family_below(physical), surface, supported);
        *supported &= vk::Bool32::from(draws);
        result
    }
}

pub unsafe extern "system" fn queue(device: vk::Device, _: u32, index: u32, queue: *mut vk::Queue) {
    let below = below::device(device);
    let family = family_below(below.physical);
    // SAFETY: the arguments are the caller's; the device has one queue of that family.
    unsafe { (below.core.fp_v1_0().get_device_queue)(device, family, index, queue) };
}

pub unsafe extern "system" fn queue2(
    device: vk::Device,
    info: *const vk::DeviceQueueInfo2,
    queue: *mut vk::Queue,
) {
    let below = below::device(device);
    // SAFETY: as above.
    unsafe {
        let info =
            vk::DeviceQueueInfo2 { queue_family_index: family_below(below.physical), ..*info };
        (below.core.fp_v1_1().get_device_queue2)(device, &raw const info, queue);
    }
}

pub unsafe extern "system" fn create_command_pool(
    device: vk::Device,
    info: *const vk::CommandPoolCreateInfo,
    allocator: *const vk::AllocationCallbacks,
    pool: *mut vk::CommandPool,
) -> vk::Result {
    let below = below::device(device);
    // SAFETY: as above.
    unsafe {
        let info =
            vk::CommandPoolCreateInfo { queue_family_index: family_below(below.physical), ..*info };
        (below.core.fp_v1_0().create_command_pool)(device, &raw const info, allocator, pool)
    }
}

pub unsafe extern "system" fn submit(
    queue: vk::Queue,
    count: u32,
    submits: *const vk::SubmitInfo,
    fence: vk::Fence,
) -> vk::Result {
    SUBMITS.fetch_add(1, Ordering::Relaxed);
    // SAFETY: the arguments are the caller's.
    unsafe { (below::device(queue).core.fp_v1_0().queue_submit)(queue, count, submits, fence) }
}

pub unsafe extern "system" fn submit2(
    queue: vk::Queue,
    count: u32,
    submits: *const vk::SubmitInfo2,
    fence: vk::Fence,
) -> vk::Result {
    SUBMITS.fetch_add(1, Ordering::Relaxed);
    // SAFETY: the arguments are the caller's.
    unsafe { (below::device(queue).core.fp_v1_3().queue_submit2)(queue, count, submits, fence) }
}

/// The number of submissions.
pub fn submits() -> u32 {
    SUBMITS.load(Ordering::Relaxed)
}
