//! A Vulkan layer for tests: simulates displays and cards that behave unlike a software driver.
//!
//! The variable `DISPLAY_FAULTS` contains words, separated by commas:
//! - `suboptimal`: every acquired or presented image is suboptimal, as in XWayland when a window is scaled.
//!   The image is presented all the same.
//! - `out-of-date=N`: the present of that number, from 1 on, shows nothing and returns out of date; its
//!   semaphores are waited for, as Vulkan requires.
//! - `deep`: the window's only format is `A2B10G10R10_UNORM_PACK32`. Below it is `A2R10G10B10_UNORM_PACK32`,
//!   the format of an X server of depth 30, to which a software driver can blit without promising it.
//! - `images=N`: a swapchain has at least this many images.
//! - `fast=N`: the card's clock is this many times slower, so that everything seems faster; and the card is
//!   not a software device.
//! - `no-figures`: the compiler's statistics are not available.
//! - `tell=FILE`: when the device is destroyed, three numbers are written to the file: the swapchains
//!   created, the images acquired, and the images presented.

mod card;
mod display;
mod entry;
mod words;

/// The layer's name in its manifest.
pub const NAME: &str = "VK_LAYER_TESTS_display_faults";

pub use entry::display_faults_negotiate;
