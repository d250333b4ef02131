//! Thin Vulkan: each file wraps one noun, frees what it made, and leaves the raw handles public.

mod accel;
mod agreement;
pub mod barrier;
mod blueprint;
mod buffer;
mod context;
pub mod contraction;
pub mod device;
mod emulation;
mod enumeration;
mod executable;
mod features;
mod geometry;
mod image;
pub mod instance;
mod layout;
mod limits;
mod margin;
mod memory;
pub mod micromap;
pub mod order;
mod pipeline;
mod pipeline_cache;
mod queries;
mod reflection;
mod requirements;
pub mod sbt;
pub mod shader;
mod staging;
mod statistics;
mod submit;
mod swapchain;
mod texture;
mod threads;
mod timing;
mod validation;

pub use accel::{AccelerationStructure, BuildOptions, OpacityMicromap};
pub use blueprint::{Attachments, Binding, Blueprint, Group, Stage};
pub use buffer::{ADDRESS_ALIGNMENT, Buffer};
pub use context::{Gpu, GpuContext, GpuOptions};
pub use device::{device_lines, named as named_device};
pub use emulation::{Emulation, Plain};
pub use enumeration::{Number, ShaderConstant, ShaderEnum, words, words_len};
pub use executable::Executable;
pub use features::Features;
pub use geometry::Geometry;
pub use image::{Image, Texels, transition};
pub use instance::{Vulkan, WindowHandles};
pub use layout::{Address, EnumLayout, Known, ShaderStruct, ShaderType, StructLayout};
pub use limits::Limits;
pub use margin::{margin, padded, reach, sphere_bounds};
pub use pipeline::{
    Band, ComputePipeline, Descriptor, GraphicsPipeline, HitGroup, Pipeline, PipelineBuilder,
    RayTracingPipeline,
};
pub use pipeline_cache::PipelineCache;
pub use reflection::{Bound, Reflection};
pub use requirements::{Requirement, Requirements};
pub use sbt::{Record, ShaderBindingTable};
pub use statistics::Statistics;
pub use swapchain::{Acquired, Swapchain};
pub use texture::TextureTable;
pub use threads::ensure_threads;
pub use timing::Timer;
pub use validation::Messages;
