//! The display: its swapchains, and the result for each image.

use std::fs;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use ash::vk;
use layer::below;

use crate::words;

static SWAPCHAINS: AtomicU32 = AtomicU32::new(0);
static ACQUIRED: AtomicU32 = AtomicU32::new(0);
static PRESENTED: AtomicU32 = AtomicU32::new(0);

/// Writes the counts, if they are requested.
pub fn tell() {
    let Some(file) = words::value::<String>("tell") else { return };
    let [swapchains, acquired, presented] =
        [&SWAPCHAINS, &ACQUIRED, &PRESENTED].map(|counted| counted.load(Relaxed));
    let told = format!("{swapchains} {acquired} {presented}");
    fs::write(&file, told).unwrap_or_else(|error| panic!("{file}: {error}"));
}

/// # Safety
/// As Vulkan's, here and below.
pub unsafe extern "system" fn capabilities(
    physical: vk::PhysicalDevice,
    surface: vk::SurfaceKHR,
    capabilities: *mut vk::SurfaceCapabilitiesKHR,
) -> vk::Result {
    // SAFETY: the arguments are the caller's.
    unsafe {
        let ask = below::instance(physical).surface.get_physical_device_surface_capabilities_khr;
        let result = ask(physical, surface, capabilities);
        if let (vk::Result::SUCCESS, Some(least)) = (result, words::value::<u32>("images")) {
            (*capabilities).min_image_count = (*capabilities).min_image_count.max(least);
        }
        result
    }
}

pub unsafe extern "system" fn formats(
    physical: vk::PhysicalDevice,
    surface: vk::SurfaceKHR,
    count: *mut u32,
    formats: *mut vk::SurfaceFormatKHR,
) -> vk::Result {
    // SAFETY: the arguments are the caller's; `formats` is null or has room for `count`.
    unsafe {
        if !words::has("deep") {
            let ask = below::instance(physical).surface.get_physical_device_surface_formats_khr;
            return ask(physical, surface, count, formats);
        }
        let format = vk::Format::A2B10G10R10_UNORM_PACK32;
        let color_space = vk::ColorSpaceKHR::SRGB_NONLINEAR;
        if !formats.is_null() && *count > 0 {
            formats.write(vk::SurfaceFormatKHR { format, color_space });
        }
        *count = 1;
    }
    vk::Result::SUCCESS
}

pub unsafe extern "system" fn create_swapchain(
    device: vk::Device,
    info: *const vk::SwapchainCreateInfoKHR,
    allocator: *const vk::AllocationCallbacks,
    swapchain: *mut vk::SwapchainKHR,
) -> vk::Result {
    SWAPCHAINS.fetch_add(1, Relaxed);
    // SAFETY: the arguments are the caller's.
    unsafe {
        let mut info = *info;
        if words::has("deep") {
            info.image_format = vk::Format::A2R10G10B10_UNORM_PACK32;
        }
        let make = below::device(device).swapchain.create_swapchain_khr;
        make(device, &raw const info, allocator, swapchain)
    }
}

pub unsafe extern "system" fn acquire(
    device: vk::Device,
    swapchain: vk::SwapchainKHR,
    patience: u64,
    semaphore: vk::Semaphore,
    fence: vk::Fence,
    index: *mut u32,
) -> vk::Result {
    // SAFETY: the arguments are the caller's.
    let result = unsafe {
        let acquire = below::device(device).swapchain.acquire_next_image_khr;
        acquire(device, swapchain, patience, semaphore, fence, index)
    };
    if result == vk::Result::SUCCESS || result == vk::Result::SUBOPTIMAL_KHR {
        ACQUIRED.fetch_add(1, Relaxed);
    }
    judged(result)
}

pub unsafe extern "system" fn present(
    queue: vk::Queue,
    info: *const vk::PresentInfoKHR,
) -> vk::Result {
    let below = below::device(queue);
    let number = PRESENTED.fetch_add(1, Relaxed) + 1;
    // SAFETY: the arguments are the caller's; the semaphores are those of this present.
    unsafe {
        if words::value("out-of-date") == Some(number) {
            let info = &*info;
            let (count, semaphores) = (info.wait_semaphore_count, info.p_wait_semaphores);
            let waited = std::slice::from_raw_parts(semaphores, count as usize);
            let stages = vec![vk::PipelineStageFlags::ALL_COMMANDS; waited.len()];
            let wait =
                vk::SubmitInfo::default().wait_semaphores(waited).wait_dst_stage_mask(&stages);
            return match below.core.queue_submit(queue, &[wait], vk::Fence::null()) {
                Ok(()) => vk::Result::ERROR_OUT_OF_DATE_KHR,
                Err(error) => error,
            };
        }
        judged((below.swapchain.queue_present_khr)(queue, info))
    }
}

/// The display's result for an image that it would accept unchanged.
fn judged(result: vk::Result) -> vk::Result {
    match result {
        vk::Result::SUCCESS if words::has("suboptimal") => vk::Result::SUBOPTIMAL_KHR,
        result => result,
    }
}
