//! The framework of the book *Ray Tracing in Vulkan*. The book's own programs call it `common`; a program of
//! one's own begins with [`prelude`], and `cargo chapters start` makes one. What lives where:
//!
//! - [`app`]: a program: arguments, controls, window, headless run, picture
//! - [`gpu`]: thin Vulkan: context, buffer, image, acceleration structure, pipeline, SBT, shader, timing
//! - [`model`]: OBJ, MTL and PNG files, read within limits and with warnings
//! - [`scene`]: what is rendered: camera, light, mesh, material, chess, upload
//! - [`exit`]: how a program ends
//! - [`files`], [`output`], [`UsageError`]: files written whole; what a program says; the error that means "wrong
//!   arguments"
//! - [`paths`]: the crate that a program belongs to
//! - [`workers`]: work that is shared among the processors
//!
//! Arrows point one way: samples → instruments → app → gpu; `model` → `scene`; `scene` uses `gpu` only to upload. The crate
//! `instruments` watches runs, and nothing here knows it: it meets a run in [`app::RunHooks`], and a device in
//! [`gpu::DriverShim`]. The crate `reference`, what the GPU is held to, knows none of them.
//! A helper enters only once a chapter has shown it raw.

// The code here says `common`, as the samples do.
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
// The crates whose types are in the signatures of this one: a program needs no versions of its own.
pub use {anyhow, ash, bytemuck, glam};
