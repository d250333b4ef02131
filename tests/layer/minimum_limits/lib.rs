//! A Vulkan layer for tests: it shows the device below as the narrowest that runs these samples.
//!
//! Every limit is the least, or for alignments the most, that the Vulkan 1.3 specification allows (chapter
//! "Limits", table "Required Limits"), and every feature that it does not require is missing, except for
//! `scalarBlockLayout`, which each chapter from 02 on asks for. Memory is split as on a discrete card, and
//! a queue that only copies comes before those that compute. Where the validation layer lies above this
//! one, it holds programs to all of that.
//!
//! The variable `MINIMUM_LIMITS` holds words, separated by commas, for what else a machine may do:
//! - `compute-only`: no queue family has graphics, as on data-centre cards.
//! - `heap=BYTES`: device memory has that size.
//! - `loose-buffers`: buffers need an alignment of no more than 4 bytes, as with one driver of AMD's.
//! - `no-transfer-dst`: images of a window cannot be copied to.
//! - `out-of-date`: the first swapchain is out of date before it is made.
//! - `without=FEATURE`: that feature is missing too.
//! - `no-ray-tracing`: every extension of ray tracing is hidden, with its features and limits; a buffer for it is
//!   refused, and a barrier that names its stages ends the process.
//! - `queries`: the device offers ray queries and position fetch too, and every compute shader may trace rays and read
//!   what was drawn.
//! - `portability`: the device offers `VK_KHR_portability_subset`, as those of Macs do, which has no features here.
//! - `bar`: the host can map device memory too, as with a resizable BAR.
//! - `rays=NUMBER`: one trace has at most so many rays, fewer than Vulkan allows a device to say.
//! - `tell=FILE`: when the device is destroyed, the file gets four numbers: how often was submitted, and how
//!   many allocations there were of memory in the device, in the host, and in the device but mapped.
//!
//! Nothing is in order that no barrier orders: a command that uses what an earlier one wrote, with no barrier between
//! that says so, ends the process.
//!
//! To open the device with an extension that it does not show is an error.

mod commands;
mod device;
mod drawing;
mod entry;
mod faults;
mod features;
mod limits;
mod memory;
mod order;
mod physical;
mod queues;
mod rays;

/// The layer's name in its manifest.
pub const NAME: &str = "VK_LAYER_TESTS_narrow";

pub use entry::minimum_limits_negotiate;
