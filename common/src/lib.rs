//! The framework of the book *Ray Tracing in Vulkan*. The book's own programs call it `common`; other
//! programs begin with [`prelude`], and `cargo chapters start` creates one. The modules:
//!
//! - [`app`]: a program: arguments, controls, window, headless run, picture
//! - [`gpu`]: thin Vulkan: context, buffer, image, acceleration structure, pipeline, SBT, shader, timing
//! - [`model`]: OBJ, MTL and PNG files, read within limits and with warnings
//! - [`scene`]: the scene to render: camera, light, mesh, material, chess, upload
//! - [`exit`]: the end of a program
//! - [`files`], [`output`], [`UsageError`]: files written whole; standard output and error; the error for wrong
//!   arguments
//! - [`paths`]: the folder of the program's crate
//! - [`workers`]: work shared among the processors
//!
//! Dependencies point one way: samples → instruments → app → gpu; `model` → `scene`; `scene` uses `gpu` only to upload.
//! The crate `instruments` observes runs, and nothing here depends on it: it connects to a run by [`app::RunHooks`], and
//! to a device by [`gpu::DriverShim`]. The crate `reference`, with which the GPU is compared, depends on none of them.
//! A helper is added only after a chapter has shown the code itself.

// The code here uses the name `common`, as the samples do.
extern crate self as common;
// The tests below run on the software driver.
#[cfg(test)]
use device as _;

pub mod app;
pub mod exit;
pub mod files;
pub mod gpu;
pub mod model;
pub mod output;
pub mod paths;
pub mod prelude;
pub mod scene;
mod usage_error;
pub mod workers;

pub use app::{Controls, Frame, Lighting, Playback, Sample, Setup, Variant, Variants, run};
pub use usage_error::UsageError;
// The crates whose types are in the signatures of this one, so that a program need not choose versions.
pub use {anyhow, ash, bytemuck, glam};
