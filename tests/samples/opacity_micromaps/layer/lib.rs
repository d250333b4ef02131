//! A Vulkan layer for tests: it offers `VK_KHR_opacity_micromap` above the software driver, which does not know it.
//!
//! Micromaps are records of the layer's own. It holds their structures to the specification, reads their states
//! from where a device would, and passes builds, pipelines and names on without them: traversal then calls the
//! any-hit shader for each candidate, as a device may not, but with the same picture.
//!
//! The variable `MICROMAPS` holds words, separated by commas:
//! - `level=NUMBER`: the finest level that is taken, with two states and with four; 3 if it is not said, which is
//!   the least that a device may offer.
//! - `tell=FILE`: when the device is destroyed, the file gets a line for each thing that was built, and for each
//!   rule that was broken:
//!   - `micromap LEVEL STATES`: the bytes of all triangles in the order of their numbers, in hexadecimal digits;
//!   - `level CORNERS INDICES`: of a bottom level with a micromap, the corners of each primitive and the
//!     micromap's triangle that it names, with commas between;
//!   - `pipeline`: one that may meet micromaps;
//!   - `alive NUMBER`: how many micromaps were not destroyed;
//!   - `broken WORDS`: a rule that was broken.

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
