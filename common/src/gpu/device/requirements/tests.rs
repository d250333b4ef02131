//! Devices that suit a sample, and what the others lack.

use super::*;

#[test]
fn a_device_without_ray_tracing_is_told_what_it_lacks() {
    let missing = Requirements::ray_tracing().missing(|_| false, &Features::default(), None);
    assert!(missing.contains(&"VK_KHR_ray_tracing_pipeline".to_owned()), "{missing:?}");
    assert!(missing.contains(&"feature scalarBlockLayout".to_owned()), "{missing:?}");
    assert!(!missing.contains(&"feature rayTracingPipeline".to_owned()), "named by its extension");
}

#[test]
fn compute_alone_asks_for_no_ray_tracing_and_every_other_chapter_names_what_it_lacks() {
    let is_of_rays = |name: &CStr| {
        let name = name.to_string_lossy();
        ["acceleration", "ray", "host"].iter().any(|word| name.contains(word))
    };
    let mut limits = Limits::default();
    limits.core.max_push_constants_size = 128;
    let missing = |wanted: Requirements| {
        let offered = wanted.features(&Features::default());
        wanted.missing(|name| !is_of_rays(name), &offered, Some(&limits))
    };
    assert_eq!(missing(Requirements::compute().textures().window()), [""; 0]);
    assert_eq!(
        missing(Requirements::ray_tracing()),
        [
            "VK_KHR_acceleration_structure",
            "VK_KHR_deferred_host_operations",
            "VK_KHR_ray_tracing_pipeline"
        ]
    );
    assert_eq!(
        missing(Requirements::compute().push_constants(144)),
        ["maxPushConstantsSize 144 (it has 128)"]
    );
}

#[test]
fn an_offered_extension_without_its_feature_is_not_enough() {
    let wanted = Requirements::ray_tracing();
    let mut offered = wanted.features(&Features::default());
    offered.ray_tracing_pipeline.ray_tracing_pipeline = vk::FALSE;
    assert_eq!(wanted.missing(|_| true, &offered, None), ["feature rayTracingPipeline"]);
}

#[test]
fn limits_are_judged_with_features() {
    let mut limits = Limits::default();
    limits.ray_tracing_pipeline.max_ray_recursion_depth = 1;
    limits.core.max_push_constants_size = 128;
    let missing = |wanted: Requirements| {
        wanted.missing(|_| true, &wanted.features(&Features::default()), Some(&limits))
    };
    assert_eq!(missing(Requirements::ray_tracing()), [""; 0]);
    assert_eq!(
        missing(Requirements::ray_tracing().recursion(2).push_constants(144)),
        ["maxRayRecursionDepth 2 (it has 1)", "maxPushConstantsSize 144 (it has 128)"]
    );
    assert_eq!(
        missing(Requirements::ray_tracing().exact_floats()),
        ["shaderRoundingModeRTEFloat32", "shaderSignedZeroInfNanPreserveFloat32"]
    );
}

#[test]
fn nothing_but_what_was_asked_is_enabled() {
    let mut features = Requirements::ray_tracing().features(&Features::default());
    assert_eq!(features.vulkan12.runtime_descriptor_array, vk::FALSE);
    assert_eq!(features.vulkan13.dynamic_rendering, vk::FALSE);
    features = Requirements::ray_tracing().textures().features(&Features::default());
    assert_eq!(features.vulkan12.runtime_descriptor_array, vk::TRUE);
}

#[test]
fn a_wish_is_granted_where_it_is_offered_and_refuses_no_device() {
    let wishing = Requirements::ray_tracing().float64_where_offered();
    let mut offered = wishing.features(&Features::default());
    assert_eq!(offered.core.shader_float64, vk::FALSE);
    assert!(wishing.missing(|_| true, &offered, None).is_empty());
    offered.core.shader_float64 = vk::TRUE;
    assert_eq!(wishing.features(&offered).core.shader_float64, vk::TRUE);
    let wishing = wishing.compiler_figures_where_offered();
    let name = khr::pipeline_executable_properties::NAME;
    assert!(!wishing.extensions(&offered).contains(&name));
    offered.executable.pipeline_executable_info = vk::TRUE;
    assert!(wishing.extensions(&offered).contains(&name));
}
