//! Thin Vulkan: each file wraps one noun, frees what it made, and leaves the raw handles public.
//!
//! - [`device`]: the instance, the choice of a device, its features and limits
//! - [`memory`]: buffers, images, textures, staging
//! - [`accel`]: acceleration structures, and what their builds are given
//! - [`pipeline`]: shaders, pipelines, the shader binding table
//! - [`check`]: what is compared with what: shaders with Rust, calls with the specification
//! - here: barriers, submission, timing, the swapchain

pub mod accel;
pub mod barrier;
pub mod check;
pub mod device;
pub mod memory;
pub mod pipeline;
mod queries;
mod submit;
mod swapchain;
mod timing;

pub use accel::geometry::Geometry;
pub use accel::margin::{margin, padded, reach, sphere_bounds};
pub use accel::order;
pub use accel::{AccelerationStructure, BuildOptions, OpacityMicromap};
pub use check::driver_shim::{DriverShim, Plain};
pub use check::executable::Executable;
pub use check::reflection::{Bound, Reflection};
pub use check::statistics::Statistics;
pub use check::validation::Messages;
pub use device::context::{Gpu, GpuContext, GpuOptions};
pub use device::features::Features;
pub use device::instance::{Vulkan, WindowHandles};
pub use device::limits::Limits;
pub use device::requirements::{Requirement, Requirements};
pub use device::threads::ensure_threads;
pub use device::{device_lines, named as named_device};
pub use memory::buffer::{ADDRESS_ALIGNMENT, Buffer};
pub use memory::image::{Image, Texels, transition};
pub use memory::sampling::{Sampling, Wrap};
pub use memory::texture::TextureTable;
pub use pipeline::cache::PipelineCache;
pub use pipeline::desc::{Attachments, Binding, Group, PipelineDesc, Stage};
pub use pipeline::enumeration::{Number, ShaderConstant, ShaderEnum, words, words_len};
pub use pipeline::layout::{
    Address, EnumLayout, Known, Scalar, ShaderStruct, ShaderType, StructLayout,
};
pub use pipeline::sbt::{Record, ShaderBindingTable};
pub use pipeline::{
    Asked, AskedRecord, Band, ComputePipeline, Descriptor, GraphicsPipeline, HitGroup, Pipeline,
    PipelineBuilder, RayTracingPipeline, contraction, sbt, shader,
};
pub use submit::is_at_work;
pub use swapchain::{Acquired, Swapchain};
pub use timing::Timer;
