//! GPUs without the hardware: complete drivers of cards, the figures of their compilers for the chapters, and
//! the narrowest device Vulkan allows.

mod budgets;
#[cfg(target_os = "linux")]
mod cards;
#[cfg(target_os = "linux")]
mod choice;
#[cfg(target_os = "linux")]
mod intel;
#[cfg(target_os = "linux")]
mod narrowest;
#[cfg(target_os = "linux")]
mod sweep;
#[cfg(target_os = "linux")]
mod without_rays;
