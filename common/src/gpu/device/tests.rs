//! Devices chosen, and refused for missing features.

use super::*;

fn candidate(
    index: usize,
    name: &str,
    kind: vk::PhysicalDeviceType,
    missing: &[&str],
) -> Candidate {
    let mut candidate = Candidate { index, name: name.to_owned(), ..Candidate::default() };
    candidate.properties.device_type = kind;
    candidate.missing = missing.iter().map(|&m| m.to_owned()).collect();
    candidate
}

fn three() -> Vec<Candidate> {
    vec![
        candidate(0, "llvmpipe", vk::PhysicalDeviceType::CPU, &[]),
        candidate(
            1,
            "Old Card",
            vk::PhysicalDeviceType::DISCRETE_GPU,
            &["VK_KHR_ray_tracing_pipeline"],
        ),
        candidate(2, "Radeon", vk::PhysicalDeviceType::INTEGRATED_GPU, &[]),
    ]
}

#[test]
fn a_real_gpu_goes_before_the_software_driver() {
    assert_eq!(choose(three(), None).unwrap().name, "Radeon");
}

#[test]
fn a_device_can_be_asked_for_by_number_and_by_name() {
    assert_eq!(choose(three(), Some("0")).unwrap().name, "llvmpipe");
    assert_eq!(choose(three(), Some("radeon")).unwrap().index, 2);
}

#[test]
fn a_refusal_names_each_device_and_what_it_lacks() {
    let error = choose(three(), Some("1")).err().unwrap().to_string();
    assert!(error.contains("Old Card") && error.contains("VK_KHR_ray_tracing_pipeline"), "{error}");
    let error = choose(three(), Some("GeForce")).err().unwrap().to_string();
    assert!(error.contains("llvmpipe") && error.contains("Radeon"), "{error}");
    let only_old = three().into_iter().filter(|c| c.index == 1).collect();
    let error = choose(only_old, None).err().unwrap().to_string();
    assert!(error.contains("Old Card") && error.contains("./setup"), "{error}");
    assert!(choose(Vec::new(), None).err().unwrap().to_string().contains("no Vulkan device"));
}
