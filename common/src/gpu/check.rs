//! Checks made before anything runs: a shader's interface against the structures in Rust, a pipeline's shaders
//! against each other, Vulkan calls against the specification; and a driver's statistics of its pipelines.

pub mod driver_shim;
pub mod executable;
mod image_format;
pub mod interface_check;
pub mod reflection;
pub mod statistics;
pub mod table;
pub mod validation;
