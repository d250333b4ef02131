//! A Vulkan layer for tests: adds `VK_KHR_opacity_micromap` to the software driver, which lacks it.
//!
//! Micromaps are records of the layer itself. It checks their structures against the specification, reads
//! their states from where a device would, and passes builds, pipelines and names on without them. Traversal
//! then calls the any-hit shader for each candidate, which a device may skip, but the picture is the same.
//!
//! The variable `MICROMAPS` contains words, separated by commas:
//! - `level=NUMBER`: the finest supported level, with two states and with four; by default 3, the least a
//!   device may support.
//! - `tell=FILE`: when the device is destroyed, one line is written to the file for each build and for each
//!   violated rule:
//!   - `micromap LEVEL STATES`: the bytes of all triangles in order, in hexadecimal digits;
//!   - `level CORNERS INDICES`: for a bottom level with a micromap, the vertices of each primitive and the
//!     index of its triangle in the micromap, separated by commas;
//!   - `pipeline`: one that allows micromaps;
//!   - `alive NUMBER`: the number of micromaps that were not destroyed;
//!   - `broken WORDS`: a violated rule.

mod builds;
mod create;
mod device;
mod entry;
mod physical;
mod record;
mod structures;

/// The layer's name in its manifest.
pub const NAME: &str = "VK_LAYER_TESTS_micromaps";

pub use entry::micromaps_negotiate;
