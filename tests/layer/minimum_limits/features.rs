//! The features that Vulkan 1.3 and the two ray tracing extensions require (chapter "Features", "Feature
//! Requirements"), and `scalarBlockLayout`.

use ash::vk;
use ash::vk::{FALSE, TRUE};

use crate::faults;

/// The features of Vulkan 1.0. Acceleration structures require descriptor indexing, and that requires dynamic
/// indexing.
pub fn core() -> vk::PhysicalDeviceFeatures {
    vk::PhysicalDeviceFeatures {
        robust_buffer_access: TRUE,
        shader_sampled_image_array_dynamic_indexing: TRUE,
        shader_storage_buffer_array_dynamic_indexing: TRUE,
        ..Default::default()
    }
}

fn vulkan11() -> vk::PhysicalDeviceVulkan11Features<'static> {
    vk::PhysicalDeviceVulkan11Features { multiview: TRUE, ..Default::default() }
}

fn vulkan12() -> vk::PhysicalDeviceVulkan12Features<'static> {
    vk::PhysicalDeviceVulkan12Features {
        descriptor_indexing: TRUE,
        shader_uniform_texel_buffer_array_dynamic_indexing: TRUE,
        shader_storage_texel_buffer_array_dynamic_indexing: TRUE,
        shader_sampled_image_array_non_uniform_indexing: TRUE,
        shader_storage_buffer_array_non_uniform_indexing: TRUE,
        shader_uniform_texel_buffer_array_non_uniform_indexing: TRUE,
        descriptor_binding_sampled_image_update_after_bind: TRUE,
        descriptor_binding_storage_image_update_after_bind: TRUE,
        descriptor_binding_storage_buffer_update_after_bind: TRUE,
        descriptor_binding_uniform_texel_buffer_update_after_bind: TRUE,
        descriptor_binding_storage_texel_buffer_update_after_bind: TRUE,
        descriptor_binding_update_unused_while_pending: TRUE,
        descriptor_binding_partially_bound: TRUE,
        runtime_descriptor_array: TRUE,
        scalar_block_layout: TRUE,
        imageless_framebuffer: TRUE,
        uniform_buffer_standard_layout: TRUE,
        shader_subgroup_extended_types: TRUE,
        separate_depth_stencil_layouts: TRUE,
        host_query_reset: TRUE,
        timeline_semaphore: TRUE,
        buffer_device_address: TRUE,
        vulkan_memory_model: TRUE,
        vulkan_memory_model_device_scope: TRUE,
        subgroup_broadcast_dynamic_id: TRUE,
        ..Default::default()
    }
}

fn vulkan13() -> vk::PhysicalDeviceVulkan13Features<'static> {
    vk::PhysicalDeviceVulkan13Features {
        robust_image_access: TRUE,
        inline_uniform_block: TRUE,
        descriptor_binding_inline_uniform_block_update_after_bind: TRUE,
        pipeline_creation_cache_control: TRUE,
        private_data: TRUE,
        shader_demote_to_helper_invocation: TRUE,
        shader_terminate_invocation: TRUE,
        subgroup_size_control: TRUE,
        compute_full_subgroups: TRUE,
        synchronization2: TRUE,
        shader_zero_initialize_workgroup_memory: TRUE,
        dynamic_rendering: TRUE,
        shader_integer_dot_product: TRUE,
        maintenance4: TRUE,
        ..Default::default()
    }
}

/// A feature's value, unless the variable removes it.
fn keep(name: &str, value: &mut vk::Bool32) {
    if faults::value("without").is_some_and(|without| without == name) {
        *value = FALSE;
    }
}

/// Reduces one structure of a chain to the required features, if it is one that these samples use.
pub fn narrow(link: *mut vk::BaseOutStructure) {
    use vk::StructureType as Type;
    // SAFETY: the link is the caller's, and its type identifies it; its place in the chain is preserved.
    unsafe {
        let p_next = (*link).p_next.cast();
        match (*link).s_type {
            Type::PHYSICAL_DEVICE_VULKAN_1_1_FEATURES => {
                *link.cast() = vk::PhysicalDeviceVulkan11Features { p_next, ..vulkan11() };
            }
            Type::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES => {
                let own = &mut *link.cast();
                *own = vk::PhysicalDeviceVulkan12Features { p_next, ..vulkan12() };
                keep("bufferDeviceAddress", &mut own.buffer_device_address);
                keep("scalarBlockLayout", &mut own.scalar_block_layout);
                keep("runtimeDescriptorArray", &mut own.runtime_descriptor_array);
                keep(
                    "descriptorBindingSampledImageUpdateAfterBind",
                    &mut own.descriptor_binding_sampled_image_update_after_bind,
                );
                keep(
                    "shaderSampledImageArrayNonUniformIndexing",
                    &mut own.shader_sampled_image_array_non_uniform_indexing,
                );
            }
            Type::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES => {
                let own = &mut *link.cast();
                *own = vk::PhysicalDeviceVulkan13Features { p_next, ..vulkan13() };
                keep("synchronization2", &mut own.synchronization2);
                keep("dynamicRendering", &mut own.dynamic_rendering);
            }
            Type::PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR => {
                let own = &mut *link.cast();
                *own = vk::PhysicalDeviceAccelerationStructureFeaturesKHR {
                    p_next,
                    acceleration_structure: TRUE,
                    descriptor_binding_acceleration_structure_update_after_bind: TRUE,
                    ..Default::default()
                };
                keep("accelerationStructure", &mut own.acceleration_structure);
            }
            Type::PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR => {
                let own = &mut *link.cast();
                *own = vk::PhysicalDeviceRayTracingPipelineFeaturesKHR {
                    p_next,
                    ray_tracing_pipeline: TRUE,
                    ray_tracing_pipeline_trace_rays_indirect: TRUE,
                    ..Default::default()
                };
                keep("rayTracingPipeline", &mut own.ray_tracing_pipeline);
            }
            _ => {}
        }
    }
}
