//! A Vulkan layer for tests: a display and a card that answer as some do which a software driver is not.
//!
//! The variable `DISPLAY_FAULTS` holds words, separated by commas:
//! - `suboptimal`: every image that is acquired or presented is called suboptimal, as by XWayland when a window
//!   is scaled. The image is presented all the same.
//! - `out-of-date=N`: the present of that number, from 1 on, shows nothing and finds the swapchain out of date;
//!   its semaphores are waited for, as Vulkan asks.
//! - `deep`: the window's one format is `A2B10G10R10_UNORM_PACK32`. Below it is `A2R10G10B10_UNORM_PACK32`, which
//!   an X server of depth 30 has, and which a software driver can blit to but does not promise to.
//! - `images=N`: a swapchain has at least so many images.
//! - `fast=N`: the card's clock ticks so many times as slowly, so that all seems as much faster; and the card is
//!   no software.
//! - `no-figures`: the compiler's figures cannot be had.
//! - `tell=FILE`: when the device is destroyed, the file gets three numbers: how many swapchains were made, how
//!   many images acquired, and how many presented.

mod card;
mod display;
mod entry;
mod words;

/// The layer's name in its manifest.
pub const NAME: &str = "VK_LAYER_TESTS_display_faults";

pub use entry::display_faults_negotiate;
