//! The framework that the samples share. What lives where:
//!
//! - [`app`]: a program: arguments, controls, window, headless run, picture
//! - [`gpu`]: thin Vulkan: context, buffer, image, acceleration structure, pipeline, SBT, shader, timing
//! - [`scene`]: camera, light, mesh, material, OBJ files, chess, upload
//! - [`files`], [`output`], [`usage`]: files written whole; what a program says; the error that means "wrong
//!   arguments"
//!
//! Arrows point one way: samples → instruments → app → gpu; `scene` uses `gpu` only to upload. The crate
//! `instruments` watches runs, and nothing here knows it: it meets a run in [`app::Watch`], and a device in
//! [`gpu::Emulation`]. The crate `reference`, what the GPU is held to, knows none of them.
//! A helper enters only once a chapter has shown it raw.

// The macro `shader_struct!` names this crate by its outside name, here as in the samples.
extern crate self as common;
// The tests below run on the software driver.
#[cfg(test)]
use device as _;

pub mod app;
pub mod files;
pub mod gpu;
pub mod output;
pub mod scene;
pub mod usage;

pub use app::{Controls, Frame, Lighting, Playback, Sample, Setup, Variant, Variants};
pub use bytemuck;
