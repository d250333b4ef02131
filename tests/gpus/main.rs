//! GPUs that are not here: cards whose drivers are, what their compilers make of the chapters, and the narrowest
//! device that Vulkan allows.

mod budgets;
#[cfg(target_os = "linux")]
mod cards;
#[cfg(target_os = "linux")]
mod choice;
#[cfg(target_os = "linux")]
mod narrowest;
#[cfg(target_os = "linux")]
mod without_rays;
