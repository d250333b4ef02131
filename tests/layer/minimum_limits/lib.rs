//! A Vulkan layer for tests: presents the device below as the narrowest that runs these samples.
//!
//! Every limit is the least, or for alignments the most, that the Vulkan 1.3 specification allows (chapter
//! "Limits", table "Required Limits"), and every feature that it does not require is missing, except for
//! `scalarBlockLayout`, which each chapter from 02 on needs. Memory is split as on a discrete card, and a
//! queue that only copies comes before those that compute. The validation layer above this one checks
//! programs against all of that.
//!
//! The variable `MINIMUM_LIMITS` contains words, separated by commas, for further properties of a machine:
//! - `compute-only`: no queue family has graphics, as on data-centre cards.
//! - `heap=BYTES`: device memory has that size.
//! - `loose-buffers`: buffers need an alignment of no more than 4 bytes, as with one of AMD's drivers.
//! - `no-transfer-dst`: images of a window cannot be copied to.
//! - `out-of-date`: the first swapchain is out of date before it is made.
//! - `without=FEATURE`: that feature is missing too.
//! - `no-ray-tracing`: every ray tracing extension is hidden, with its features and limits; a buffer for it
//!   is refused, and a barrier that names its stages ends the process.
//! - `queries`: the device also supports ray queries and position fetch, and every compute shader may trace
//!   rays and read the result of drawing.
//! - `portability`: the device supports `VK_KHR_portability_subset`, as on Macs, here without any of its
//!   features.
//! - `bar`: the host can also map device memory, as with a resizable BAR.
//! - `rays=NUMBER`: one trace has at most this many rays, fewer than Vulkan allows a device to report.
//! - `tell=FILE`: when the device is destroyed, four numbers are written to the file: the submissions, and
//!   the allocations in device memory, in host memory, and in mapped device memory.
//!
//! Commands are only ordered by barriers: a command that uses the result of an earlier one, without a
//! suitable barrier between them, ends the process.
//!
//! Creating the device with an extension that it does not report is an error.

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
