//! GPUs that are not here: what their compilers make of the chapters, and the narrowest that Vulkan allows.

mod budgets;
#[cfg(target_os = "linux")]
mod choice;
#[cfg(target_os = "linux")]
mod narrowest;
