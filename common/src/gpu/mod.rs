//! Thin Vulkan: each file wraps one noun, frees what it made, and leaves the raw handles public.

mod accel;
mod arithmetic;
pub mod barrier;
mod blueprint;
mod buffer;
mod contents;
mod context;
mod contraction;
mod device;
mod enumeration;
mod executable;
mod features;
mod geometry;
mod image;
mod instance;
mod layout;
mod limits;
mod margin;
pub mod null;
pub mod order;
mod pack;
mod pipeline;
mod pipeline_cache;
mod reflection;
mod requirements;
pub mod sbt;
pub mod shader;
mod statistics;
mod submit;
mod swapchain;
mod texture;
mod threads;
mod timing;
mod validation;
mod variants;

pub use accel::{AccelerationStructure, BuildOptions, Input};
pub use arithmetic::Arithmetic;
pub use blueprint::{Attachments, Blueprint, Group, Stage};
pub use buffer::{ADDRESS_ALIGNMENT, Buffer};
pub use contents::Contents;
pub use context::{Gpu, GpuContext, GpuOptions};
pub use device::device_lines;
pub use enumeration::{Number, ShaderConstant, ShaderEnum, words, words_len};
pub use executable::Executable;
pub use features::Features;
pub use geometry::Geometry;
pub use image::{Image, Texels, transition, whole};
pub use instance::{WindowHandles, load};
pub use layout::{Address, EnumLayout, Known, ShaderStruct, ShaderType, StructLayout};
pub use limits::Limits;
pub use margin::{margin, padded};
pub use pack::Pack;
pub use pipeline::{
    Band, Binding, ComputePipeline, Descriptor, GraphicsPipeline, HitGroup, Pipeline,
    PipelineBuilder, RayTracingPipeline,
};
pub use pipeline_cache::PipelineCache;
pub use reflection::{Bound, Reflection};
pub use requirements::{Requirement, Requirements};
pub use sbt::{Record, ShaderBindingTable};
pub use statistics::Statistics;
pub use swapchain::{Acquired, Swapchain};
pub use texture::TextureTable;
pub use timing::Timer;
pub use validation::Messages;
pub use variants::{Launch, Make, Variant, Variants};
