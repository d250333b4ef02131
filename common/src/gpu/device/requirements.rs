//! A sample's requirements: Vulkan features and the extensions that provide them.
//!
//! A chapter that needs more than the baseline adds a line in `requirements()`. Only the required features are
//! enabled, so that validation catches any other feature used by accident.

use std::ffi::CStr;

use ash::{khr, vk};

use super::newer::{INVOCATION_REORDER, SHADER_FMA};
use crate::gpu::accel::micromap_extension::{DEVICE_ADDRESS_COMMANDS, OPACITY_MICROMAP};
use crate::gpu::{Features, Limits};

/// One feature bit, its extension, and functions to read and set it.
#[derive(Clone, Copy)]
pub struct Requirement {
    /// The feature's name in the specification, as an error shows it.
    pub name: &'static str,
    /// The extension that must be enabled with it; `None` if it is part of core Vulkan 1.3.
    pub extension: Option<&'static CStr>,
    bit: fn(&mut Features) -> &mut vk::Bool32,
}

impl Requirement {
    fn is_in(&self, features: &Features) -> bool {
        let mut features = *features;
        *(self.bit)(&mut features) == vk::TRUE
    }
}

macro_rules! requirement {
    ($extension:expr, $name:literal, $($field:ident).+) => {
        Requirement { name: $name, extension: $extension, bit: |features| &mut features.$($field).+ }
    };
}

/// Features for tracing rays, in addition to [`COMPUTE`].
const RAY_TRACING: [Requirement; 2] = [
    requirement!(
        Some(khr::acceleration_structure::NAME),
        "accelerationStructure",
        acceleration_structure.acceleration_structure
    ),
    requirement!(
        Some(khr::ray_tracing_pipeline::NAME),
        "rayTracingPipeline",
        ray_tracing_pipeline.ray_tracing_pipeline
    ),
];

/// Features for every chapter.
const COMPUTE: [Requirement; 3] = [
    requirement!(None, "bufferDeviceAddress", vulkan12.buffer_device_address),
    requirement!(None, "scalarBlockLayout", vulkan12.scalar_block_layout),
    requirement!(None, "synchronization2", vulkan13.synchronization2),
];

/// Features for a table of textures.
const TEXTURES: [Requirement; 3] = [
    requirement!(None, "runtimeDescriptorArray", vulkan12.runtime_descriptor_array),
    requirement!(
        None,
        "descriptorBindingSampledImageUpdateAfterBind",
        vulkan12.descriptor_binding_sampled_image_update_after_bind
    ),
    requirement!(
        None,
        "shaderSampledImageArrayNonUniformIndexing",
        vulkan12.shader_sampled_image_array_non_uniform_indexing
    ),
];

/// A list of requirements, begun with [`Requirements::ray_tracing`] or [`Requirements::compute`] and extended by
/// the chapter.
#[derive(Clone, Default)]
pub struct Requirements {
    /// The nesting depth of `traceRayEXT` that every pipeline of the sample may use.
    pub recursion: u32,
    /// The most bytes of push constants in any pipeline of the sample.
    pub push_constants: u32,
    /// A queue with graphics, and depth in 32-bit floats.
    pub raster: bool,
    /// A queue with graphics, for blits.
    pub mipmaps: bool,
    exact_floats: bool,
    list: Vec<Requirement>,
    wishes: Vec<Requirement>,
    extensions: Vec<&'static CStr>,
}

impl Requirements {
    /// The baseline of every chapter that traces rays: that of [`compute`](Self::compute), ray tracing pipelines
    /// and acceleration structures; and for limits, the guaranteed minimum: a recursion depth of 1.
    pub fn ray_tracing() -> Self {
        let mut all = Self { recursion: 1, ..Self::compute() };
        all.list.splice(0..0, RAY_TRACING);
        // Acceleration structures depend on deferred host operations, even if none is used.
        all.extensions.push(khr::deferred_host_operations::NAME);
        all
    }

    /// The baseline without ray tracing: compute shaders, scalar block layout, buffer addresses,
    /// `synchronization2` and push descriptors; and for limits, the guaranteed minimum: 128 bytes of push
    /// constants.
    ///
    /// Among these, only `scalarBlockLayout` and the extension `VK_KHR_push_descriptor` are optional in Vulkan
    /// 1.3. MoltenVK 1.4, the Vulkan implementation on Macs, supports all of it, and the additions of
    /// [`textures`](Self::textures), from macOS 13 on if the GPU has argument buffers of tier 2 (its
    /// `MoltenVK_Runtime_UserGuide.md`, and `MVKPhysicalDevice::initFeatures` in `MVKDevice.mm`, read in 1.4.2).
    pub fn compute() -> Self {
        Self {
            push_constants: 128,
            list: COMPUTE.to_vec(),
            extensions: vec![khr::push_descriptor::NAME],
            ..Self::default()
        }
    }

    /// True if the sample builds acceleration structures and traces rays.
    pub fn has_ray_tracing(&self) -> bool {
        self.asks_for(khr::acceleration_structure::NAME)
    }

    /// Hit shaders that trace further rays: a recursion depth beyond the guaranteed 1.
    pub fn recursion(mut self, depth: u32) -> Self {
        self.recursion = depth;
        self
    }

    /// More push constants than the guaranteed 128 bytes.
    pub fn push_constants(mut self, bytes: u32) -> Self {
        self.push_constants = bytes;
        self
    }

    /// Shaders that declare the rounding of 32-bit floats and the sign of zeros.
    pub fn exact_floats(mut self) -> Self {
        self.exact_floats = true;
        self
    }

    /// The bindless texture table: one array of sampled images, indexed differently by each ray. It uses
    /// descriptors that may be updated after binding, of which a device must support far more.
    pub fn textures(mut self) -> Self {
        self.list.extend(TEXTURES);
        self
    }

    /// 64-bit floats in shaders.
    pub fn float64(mut self) -> Self {
        self.list.push(requirement!(None, "shaderFloat64", core.shader_float64));
        self
    }

    /// 64-bit floats in shaders, if the device supports them: see its [`Features`].
    pub fn float64_where_offered(mut self) -> Self {
        self.wishes.push(requirement!(None, "shaderFloat64", core.shader_float64));
        self
    }

    /// 64-bit integers in shaders, if the device supports them: see
    /// [`PipelineBuilder::int64`](crate::gpu::PipelineBuilder::int64).
    pub fn int64_where_offered(mut self) -> Self {
        self.wishes.push(requirement!(None, "shaderInt64", core.shader_int64));
        self
    }

    /// A product and a sum that are rounded once, if the device promises that: see
    /// [`PipelineBuilder::fma_rounded_once`](crate::gpu::PipelineBuilder::fma_rounded_once).
    pub fn fma_where_offered(mut self) -> Self {
        self.wishes.push(requirement!(
            Some(SHADER_FMA),
            "shaderFmaFloat32",
            fma.shader_fma_float32
        ));
        self
    }

    /// A clock that shaders can read, if the device has one: see its [`Features`].
    pub fn shader_clock_where_offered(mut self) -> Self {
        self.wishes.push(requirement!(
            Some(khr::shader_clock::NAME),
            "shaderSubgroupClock",
            clock.shader_subgroup_clock
        ));
        self
    }

    /// Threads that change places by what their rays met, if the device lets them: see its [`Features`].
    pub fn invocation_reorder_where_offered(mut self) -> Self {
        self.wishes.push(requirement!(
            Some(INVOCATION_REORDER),
            "rayTracingInvocationReorder",
            reorder.ray_tracing_invocation_reorder
        ));
        self
    }

    /// The corners of the triangle that was hit, from its bottom level.
    pub fn position_fetch(mut self) -> Self {
        self.list.push(requirement!(
            Some(khr::ray_tracing_position_fetch::NAME),
            "rayTracingPositionFetch",
            position_fetch.ray_tracing_position_fetch
        ));
        self
    }

    /// Rays that any stage traces, without a ray tracing pipeline.
    pub fn ray_query(mut self) -> Self {
        self.list.push(requirement!(Some(khr::ray_query::NAME), "rayQuery", ray_query.ray_query));
        self
    }

    /// True if shaders may trace rays without a ray tracing pipeline.
    pub fn has_ray_query(&self) -> bool {
        self.asks_for(khr::ray_query::NAME)
    }

    fn asks_for(&self, extension: &CStr) -> bool {
        self.list.iter().any(|requirement| requirement.extension == Some(extension))
    }

    /// Rasterised triangles: a queue with graphics, dynamic rendering, and a depth attachment of 32-bit floats,
    /// which the specification does not guarantee (it guarantees that or `X8_D24_UNORM_PACK32`).
    pub fn raster(mut self) -> Self {
        self.raster = true;
        self.list.push(requirement!(None, "dynamicRendering", vulkan13.dynamic_rendering));
        self
    }

    /// Mip levels made on the device by blits, which need a queue with graphics.
    pub fn mipmaps(mut self) -> Self {
        self.mipmaps = true;
        self
    }

    /// Rays that skip all triangles or all boxes, if the device supports it: see its [`Features`].
    pub fn primitive_culling_where_offered(mut self) -> Self {
        self.wishes.push(requirement!(
            Some(khr::ray_tracing_pipeline::NAME),
            "rayTraversalPrimitiveCulling",
            ray_tracing_pipeline.ray_traversal_primitive_culling
        ));
        self
    }

    /// Opacity micromaps used by traversal itself, if the device supports them: see
    /// [`OpacityMicromap::finest`](crate::gpu::OpacityMicromap::finest).
    pub fn opacity_micromaps_where_offered(mut self) -> Self {
        self.wishes.push(requirement!(
            Some(DEVICE_ADDRESS_COMMANDS),
            "deviceAddressCommands",
            address_commands.device_address_commands
        ));
        self.wishes.push(requirement!(Some(OPACITY_MICROMAP), "micromap", micromap.micromap));
        self
    }

    /// The driver's compiler statistics for each pipeline, if it offers them, in
    /// [`Statistics`](crate::gpu::Statistics).
    pub fn compiler_figures_where_offered(mut self) -> Self {
        self.wishes.push(requirement!(
            Some(khr::pipeline_executable_properties::NAME),
            "pipelineExecutableInfo",
            executable.pipeline_executable_info
        ));
        self
    }

    /// Additions for drawing to a window: the swapchain, and dynamic rendering for the panel.
    pub fn window(mut self) -> Self {
        self.list.push(requirement!(None, "dynamicRendering", vulkan13.dynamic_rendering));
        self.extensions.push(khr::swapchain::NAME);
        self
    }

    /// Every extension to enable, each once: of the optional ones, those in `offered`.
    pub fn extensions(&self, offered: &Features) -> Vec<&'static CStr> {
        let carried = self.granted(offered).filter_map(|requirement| requirement.extension);
        let mut all: Vec<_> = self.extensions.iter().copied().chain(carried).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The features to enable: the required ones, the optional ones in `offered`, and no others.
    pub fn features(&self, offered: &Features) -> Features {
        let mut features = Features::default();
        for requirement in self.granted(offered) {
            *(requirement.bit)(&mut features) = vk::TRUE;
        }
        features
    }

    /// The required features, and the optional ones that are offered.
    fn granted(&self, offered: &Features) -> impl Iterator<Item = &Requirement> {
        self.list.iter().chain(self.wishes.iter().filter(|wish| wish.is_in(offered)))
    }

    /// The missing features of a device with these extensions, features and limits, by name; empty if it is suitable.
    ///
    /// The limits are those of the device, if they could be queried; those of a missing extension are not checked.
    pub fn missing(
        &self,
        has_extension: impl Fn(&CStr) -> bool,
        offered: &Features,
        limits: Option<&Limits>,
    ) -> Vec<String> {
        let mut missing = Vec::new();
        for name in self.extensions(&Features::default()) {
            if !has_extension(name) {
                missing.push(name.to_string_lossy().into_owned());
            }
        }
        for requirement in &self.list {
            let carried = requirement.extension.is_none_or(&has_extension);
            if carried && !requirement.is_in(offered) {
                missing.push(format!("feature {}", requirement.name));
            }
        }
        let Some(limits) = limits else { return missing };
        let (depth, bytes) = (limits.max_ray_recursion_depth, limits.core.max_push_constants_size);
        if has_extension(khr::ray_tracing_pipeline::NAME) && self.recursion > depth {
            missing.push(format!("maxRayRecursionDepth {} (it has {depth})", self.recursion));
        }
        if self.push_constants > bytes {
            missing.push(format!("maxPushConstantsSize {} (it has {bytes})", self.push_constants));
        }
        if self.exact_floats {
            let floats = &limits.vulkan12;
            if floats.shader_rounding_mode_rte_float32 == vk::FALSE {
                missing.push("shaderRoundingModeRTEFloat32".to_owned());
            }
            if floats.shader_signed_zero_inf_nan_preserve_float32 == vk::FALSE {
                missing.push("shaderSignedZeroInfNanPreserveFloat32".to_owned());
            }
        }
        missing
    }
}

#[cfg(test)]
mod tests;
