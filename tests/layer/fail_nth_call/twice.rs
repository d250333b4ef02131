//! A copy that is made twice without a barrier: a hazard that synchronization validation reports.

use std::ffi::c_void;
use std::sync::atomic::{AtomicUsize, Ordering};

use ash::vk;

/// The copying function, as named in `FAIL`.
pub const NAME: &str = "vkCmdCopyImageToBuffer";

static BELOW: AtomicUsize = AtomicUsize::new(0);

/// The layer's replacement for the function below, if `FAIL` names it.
///
/// # Safety
/// `below` is the function of that name.
pub unsafe fn over(below: vk::PFN_vkVoidFunction) -> vk::PFN_vkVoidFunction {
    if std::env::var("FAIL").is_ok_and(|fail| fail == NAME) {
        BELOW.store(below? as usize, Ordering::Relaxed);
        // SAFETY: the address is that of a function of Vulkan's convention.
        return unsafe { layer::function(copy_twice as *const c_void) };
    }
    below
}

unsafe extern "system" fn copy_twice(
    commands: vk::CommandBuffer,
    image: vk::Image,
    layout: vk::ImageLayout,
    buffer: vk::Buffer,
    count: u32,
    regions: *const vk::BufferImageCopy,
) {
    for _ in 0..2 {
        // SAFETY: the address is that of the function of this name, and the arguments are the caller's.
        unsafe {
            let below = BELOW.load(Ordering::Relaxed);
            let copy = std::mem::transmute::<usize, vk::PFN_vkCmdCopyImageToBuffer>(below);
            copy(commands, image, layout, buffer, count, regions);
        }
    }
}
