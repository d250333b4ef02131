//! What is compared with what before anything runs: a shader's interface with the structures in Rust, a
//! pipeline's shaders with each other, Vulkan calls with the specification; and what a driver says of its
//! pipelines.

pub mod driver_shim;
pub mod executable;
pub mod interface_check;
pub mod reflection;
pub mod statistics;
pub mod validation;
