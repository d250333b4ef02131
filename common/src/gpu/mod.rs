//! Thin Vulkan: each file wraps one noun, frees what it made, and leaves the raw handles public.

mod accel;
pub mod barrier;
mod buffer;
mod contents;
mod context;
mod device;
mod exact;
mod image;
mod layout;
mod limits;
pub mod order;
mod pipeline;
mod requirements;
pub mod sbt;
pub mod shader;
mod swapchain;
mod texture;
mod timing;
mod validation;

pub use accel::{AccelerationStructure, BuildOptions, Geometry};
pub use buffer::Buffer;
pub use contents::Contents;
pub use context::{Gpu, GpuContext, GpuOptions, Statistics, WindowHandles, device_lines, load};
pub use image::{Image, transition, whole};
pub use layout::{Address, Bound, Reflection, ShaderStruct, StructLayout};
pub use limits::Limits;
pub use pipeline::{Binding, Descriptor, HitGroup, PipelineBuilder, RayTracingPipeline};
pub use requirements::{Features, Requirement, Requirements};
pub use sbt::{Record, ShaderBindingTable};
pub use swapchain::{Acquired, Swapchain};
pub use texture::TextureTable;
pub use timing::Timer;
pub use validation::Messages;
