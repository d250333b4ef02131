//! The limits: table "Required Limits" of the Vulkan 1.3 specification, chapter "Limits".
//!
//! A limit of type *min* is the number in the table, which a device may exceed; one of type *max*, such as an
//! alignment, may be smaller. In both cases, a program may rely on the number in the table.

use ash::vk;

use crate::faults;

/// The longest side of an image.
pub const IMAGE_SIDE: u32 = 4096;

/// The alignment of buffers by some drivers, which then becomes the limit for all offsets.
pub const LOOSE: u64 = 4;

const LIMITED_SAMPLES: vk::SampleCountFlags = vk::SampleCountFlags::from_raw(
    vk::SampleCountFlags::TYPE_1.as_raw() | vk::SampleCountFlags::TYPE_4.as_raw(),
);

/// Vulkan's version, the device's name, and the limits of Vulkan 1.0.
pub fn core(properties: &mut vk::PhysicalDeviceProperties) {
    properties.api_version = properties.api_version.min(vk::make_api_version(0, 1, 3, 999));
    let name = properties.device_name_as_c_str().unwrap_or_default().to_string_lossy();
    let name = std::ffi::CString::new(format!("narrow {name}")).unwrap_or_default();
    // If the name is too long, it is unchanged.
    if let Ok(named) = properties.device_name(&name) {
        *properties = named;
    }
    let offsets = if faults::has("loose-buffers") { LOOSE } else { 256 };
    properties.limits = vk::PhysicalDeviceLimits {
        max_image_dimension1_d: IMAGE_SIDE,
        max_image_dimension2_d: IMAGE_SIDE,
        max_image_dimension3_d: 256,
        max_image_dimension_cube: IMAGE_SIDE,
        max_image_array_layers: 256,
        max_texel_buffer_elements: 65_536,
        max_uniform_buffer_range: 16_384,
        max_storage_buffer_range: 1 << 27,
        max_push_constants_size: 128,
        max_memory_allocation_count: 4096,
        max_sampler_allocation_count: 4000,
        buffer_image_granularity: 131_072,
        sparse_address_space_size: 0,
        max_bound_descriptor_sets: 4,
        max_per_stage_descriptor_samplers: 16,
        max_per_stage_descriptor_uniform_buffers: 12,
        max_per_stage_descriptor_storage_buffers: 4,
        max_per_stage_descriptor_sampled_images: 16,
        max_per_stage_descriptor_storage_images: 4,
        max_per_stage_descriptor_input_attachments: 4,
        max_per_stage_resources: 128,
        max_descriptor_set_samplers: 96,
        max_descriptor_set_uniform_buffers: 72,
        max_descriptor_set_uniform_buffers_dynamic: 8,
        max_descriptor_set_storage_buffers: 24,
        max_descriptor_set_storage_buffers_dynamic: 4,
        max_descriptor_set_sampled_images: 96,
        max_descriptor_set_storage_images: 24,
        max_descriptor_set_input_attachments: 4,
        max_vertex_input_attributes: 16,
        max_vertex_input_bindings: 16,
        max_vertex_input_attribute_offset: 2047,
        max_vertex_input_binding_stride: 2048,
        max_vertex_output_components: 64,
        // No tessellation or geometry shaders.
        max_tessellation_generation_level: 0,
        max_tessellation_patch_size: 0,
        max_tessellation_control_per_vertex_input_components: 0,
        max_tessellation_control_per_vertex_output_components: 0,
        max_tessellation_control_per_patch_output_components: 0,
        max_tessellation_control_total_output_components: 0,
        max_tessellation_evaluation_input_components: 0,
        max_tessellation_evaluation_output_components: 0,
        max_geometry_shader_invocations: 0,
        max_geometry_input_components: 0,
        max_geometry_output_components: 0,
        max_geometry_output_vertices: 0,
        max_geometry_total_output_components: 0,
        max_fragment_input_components: 64,
        max_fragment_output_attachments: 4,
        max_fragment_dual_src_attachments: 0,
        max_fragment_combined_output_resources: 4,
        max_compute_shared_memory_size: 16_384,
        max_compute_work_group_count: [65_535; 3],
        max_compute_work_group_invocations: 128,
        max_compute_work_group_size: [128, 128, 64],
        sub_pixel_precision_bits: 4,
        sub_texel_precision_bits: 4,
        mipmap_precision_bits: 4,
        max_draw_indexed_index_value: (1 << 24) - 1,
        max_draw_indirect_count: 1,
        max_sampler_lod_bias: 2.0,
        max_sampler_anisotropy: 1.0,
        max_viewports: 1,
        max_viewport_dimensions: [IMAGE_SIDE; 2],
        viewport_bounds_range: [-8192.0, 8191.0],
        viewport_sub_pixel_bits: 0,
        min_memory_map_alignment: 64,
        min_texel_buffer_offset_alignment: offsets,
        min_uniform_buffer_offset_alignment: offsets,
        min_storage_buffer_offset_alignment: offsets,
        min_texel_offset: -8,
        max_texel_offset: 7,
        min_texel_gather_offset: 0,
        max_texel_gather_offset: 0,
        min_interpolation_offset: 0.0,
        max_interpolation_offset: 0.0,
        sub_pixel_interpolation_offset_bits: 0,
        max_framebuffer_width: IMAGE_SIDE,
        max_framebuffer_height: IMAGE_SIDE,
        max_framebuffer_layers: 256,
        framebuffer_color_sample_counts: LIMITED_SAMPLES,
        framebuffer_depth_sample_counts: LIMITED_SAMPLES,
        framebuffer_stencil_sample_counts: LIMITED_SAMPLES,
        framebuffer_no_attachments_sample_counts: LIMITED_SAMPLES,
        max_color_attachments: 4,
        sampled_image_color_sample_counts: LIMITED_SAMPLES,
        sampled_image_integer_sample_counts: vk::SampleCountFlags::TYPE_1,
        sampled_image_depth_sample_counts: LIMITED_SAMPLES,
        sampled_image_stencil_sample_counts: LIMITED_SAMPLES,
        storage_image_sample_counts: vk::SampleCountFlags::TYPE_1,
        max_sample_mask_words: 1,
        timestamp_compute_and_graphics: vk::FALSE,
        timestamp_period: properties.limits.timestamp_period,
        max_clip_distances: 0,
        max_cull_distances: 0,
        max_combined_clip_and_cull_distances: 0,
        discrete_queue_priorities: 2,
        point_size_range: [1.0; 2],
        line_width_range: [1.0; 2],
        point_size_granularity: 0.0,
        line_width_granularity: 0.0,
        strict_lines: vk::FALSE,
        standard_sample_locations: vk::FALSE,
        optimal_buffer_copy_offset_alignment: 256,
        optimal_buffer_copy_row_pitch_alignment: 256,
        non_coherent_atom_size: 256,
    };
}

/// Narrows one structure of a chain, if these samples depend on it.
pub fn narrow(link: *mut vk::BaseOutStructure) {
    use vk::StructureType as Type;
    // SAFETY: the link is the caller's, and its type identifies it.
    unsafe {
        match (*link).s_type {
            Type::PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES => vulkan11(&mut *link.cast()),
            Type::PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES => maintenance3(&mut *link.cast()),
            Type::PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES => vulkan12(&mut *link.cast()),
            Type::PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES => floats(&mut *link.cast()),
            Type::PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_PROPERTIES => indexing(&mut *link.cast()),
            Type::PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES => vulkan13(&mut *link.cast()),
            Type::PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES => maintenance4(&mut *link.cast()),
            Type::PHYSICAL_DEVICE_PUSH_DESCRIPTOR_PROPERTIES_KHR => {
                let push: &mut vk::PhysicalDevicePushDescriptorPropertiesKHR = &mut *link.cast();
                push.max_push_descriptors = 32;
            }
            Type::PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR => {
                acceleration_structure(&mut *link.cast());
            }
            Type::PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR => {
                ray_tracing_pipeline(&mut *link.cast());
            }
            _ => {}
        }
    }
}

fn acceleration_structure(own: &mut vk::PhysicalDeviceAccelerationStructurePropertiesKHR) {
    own.max_geometry_count = (1 << 24) - 1;
    own.max_instance_count = (1 << 24) - 1;
    own.max_primitive_count = (1 << 29) - 1;
    own.max_per_stage_descriptor_acceleration_structures = 16;
    own.max_per_stage_descriptor_update_after_bind_acceleration_structures = 500_000;
    own.max_descriptor_set_acceleration_structures = 16;
    own.max_descriptor_set_update_after_bind_acceleration_structures = 500_000;
    own.min_acceleration_structure_scratch_offset_alignment = 256;
}

fn ray_tracing_pipeline(own: &mut vk::PhysicalDeviceRayTracingPipelinePropertiesKHR) {
    own.max_ray_recursion_depth = 1;
    own.max_shader_group_stride = 4096;
    own.shader_group_base_alignment = 64;
    own.max_ray_dispatch_invocation_count = faults::value("rays")
        .map_or(1 << 30, |rays| rays.parse().expect("rays= is followed by a number"));
    own.shader_group_handle_alignment = 32;
    own.max_ray_hit_attribute_size = 32;
}

fn maintenance3(own: &mut vk::PhysicalDeviceMaintenance3Properties) {
    own.max_per_set_descriptors = 1024;
    own.max_memory_allocation_size = 1 << 30;
}

fn vulkan11(own: &mut vk::PhysicalDeviceVulkan11Properties) {
    own.max_multiview_view_count = 6;
    own.max_multiview_instance_index = (1 << 27) - 1;
    own.max_per_set_descriptors = 1024;
    own.max_memory_allocation_size = 1 << 30;
}

fn maintenance4(own: &mut vk::PhysicalDeviceMaintenance4Properties) {
    own.max_buffer_size = 1 << 30;
}

fn vulkan13(own: &mut vk::PhysicalDeviceVulkan13Properties) {
    own.max_inline_uniform_block_size = 256;
    own.max_per_stage_descriptor_inline_uniform_blocks = 4;
    own.max_per_stage_descriptor_update_after_bind_inline_uniform_blocks = 4;
    own.max_descriptor_set_inline_uniform_blocks = 4;
    own.max_descriptor_set_update_after_bind_inline_uniform_blocks = 4;
    own.max_inline_uniform_total_size = 256;
    own.max_buffer_size = 1 << 30;
}

/// Two structures of Vulkan contain the same limits under the same names.
macro_rules! float_controls {
    ($own:ident) => {
        $own.denorm_behavior_independence = vk::ShaderFloatControlsIndependence::NONE;
        $own.rounding_mode_independence = vk::ShaderFloatControlsIndependence::NONE;
        $own.shader_signed_zero_inf_nan_preserve_float16 = vk::FALSE;
        $own.shader_signed_zero_inf_nan_preserve_float32 = vk::FALSE;
        $own.shader_signed_zero_inf_nan_preserve_float64 = vk::FALSE;
        $own.shader_denorm_preserve_float16 = vk::FALSE;
        $own.shader_denorm_preserve_float32 = vk::FALSE;
        $own.shader_denorm_preserve_float64 = vk::FALSE;
        $own.shader_denorm_flush_to_zero_float16 = vk::FALSE;
        $own.shader_denorm_flush_to_zero_float32 = vk::FALSE;
        $own.shader_denorm_flush_to_zero_float64 = vk::FALSE;
        $own.shader_rounding_mode_rte_float16 = vk::FALSE;
        $own.shader_rounding_mode_rte_float32 = vk::FALSE;
        $own.shader_rounding_mode_rte_float64 = vk::FALSE;
        $own.shader_rounding_mode_rtz_float16 = vk::FALSE;
        $own.shader_rounding_mode_rtz_float32 = vk::FALSE;
        $own.shader_rounding_mode_rtz_float64 = vk::FALSE;
    };
}

/// As [`float_controls`].
macro_rules! descriptor_indexing {
    ($own:ident) => {
        $own.max_update_after_bind_descriptors_in_all_pools = 500_000;
        $own.shader_uniform_buffer_array_non_uniform_indexing_native = vk::FALSE;
        $own.shader_sampled_image_array_non_uniform_indexing_native = vk::FALSE;
        $own.shader_storage_buffer_array_non_uniform_indexing_native = vk::FALSE;
        $own.shader_storage_image_array_non_uniform_indexing_native = vk::FALSE;
        $own.shader_input_attachment_array_non_uniform_indexing_native = vk::FALSE;
        $own.robust_buffer_access_update_after_bind = vk::FALSE;
        $own.quad_divergent_implicit_lod = vk::FALSE;
        $own.max_per_stage_descriptor_update_after_bind_samplers = 500_000;
        $own.max_per_stage_descriptor_update_after_bind_uniform_buffers = 12;
        $own.max_per_stage_descriptor_update_after_bind_storage_buffers = 500_000;
        $own.max_per_stage_descriptor_update_after_bind_sampled_images = 500_000;
        $own.max_per_stage_descriptor_update_after_bind_storage_images = 500_000;
        $own.max_per_stage_descriptor_update_after_bind_input_attachments = 4;
        $own.max_per_stage_update_after_bind_resources = 500_000;
        $own.max_descriptor_set_update_after_bind_samplers = 500_000;
        $own.max_descriptor_set_update_after_bind_uniform_buffers = 72;
        $own.max_descriptor_set_update_after_bind_uniform_buffers_dynamic = 8;
        $own.max_descriptor_set_update_after_bind_storage_buffers = 500_000;
        $own.max_descriptor_set_update_after_bind_storage_buffers_dynamic = 4;
        $own.max_descriptor_set_update_after_bind_sampled_images = 500_000;
        $own.max_descriptor_set_update_after_bind_storage_images = 500_000;
        $own.max_descriptor_set_update_after_bind_input_attachments = 4;
    };
}

fn floats(own: &mut vk::PhysicalDeviceFloatControlsProperties) {
    float_controls!(own);
}

fn indexing(own: &mut vk::PhysicalDeviceDescriptorIndexingProperties) {
    descriptor_indexing!(own);
}

fn vulkan12(own: &mut vk::PhysicalDeviceVulkan12Properties) {
    float_controls!(own);
    descriptor_indexing!(own);
    own.framebuffer_integer_color_sample_counts = vk::SampleCountFlags::TYPE_1;
    own.max_timeline_semaphore_value_difference = (1 << 31) - 1;
}
