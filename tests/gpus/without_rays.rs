//! A device without ray tracing, simulated by a layer: compute runs there without messages, and every chapter
//! that traces rays is refused with the name of the missing feature.

use common::gpu::{
    Band, Binding, Buffer, ComputePipeline, Descriptor, Gpu, GpuOptions, Image, Requirements,
    Timer, barrier, device, device_lines,
};
use common::scene::{Scene, SceneAddresses, SceneOnGpu};
use run::layer::{Layer, in_child};

use ash::{khr, vk};

use super::narrowest::{quiet, runs};

/// Faults for the layer: all of ray tracing is hidden, and the device is a portability device, as on Macs.
const FAULTS: &str = "no-ray-tracing,portability";

/// The chapters that need no ray tracing.
const WITHOUT: [&str; 1] = ["30_own_tree"];

common::shader_struct! {
    struct Push {
        scene: SceneAddresses,
        band: Band,
    }
}

#[test]
fn what_traces_is_refused_by_the_extensions_that_it_lacks_and_what_computes_runs() {
    let narrow = Layer::minimum_limits(FAULTS);
    let extensions = ["VK_KHR_acceleration_structure", "VK_KHR_ray_tracing_pipeline"];
    for sample in run::chapters() {
        if WITHOUT.contains(&sample.as_str()) {
            let report = runs(&narrow, &sample, &[]);
            assert_eq!(report["limits"]["max_ray_recursion_depth"], 0, "{report}");
            continue;
        }
        let mut list = narrow.command(&sample);
        let list = quiet(&sample, list.arg("--list-devices").output().expect("it starts"));
        let mut command = narrow.command(&sample);
        let (code, line) = run::refusal(command.arg("--headless").output().expect("it starts"));
        assert_eq!(code, 1, "{sample}: {line}");
        assert!(line.contains("no device can run this: 0: narrow "), "{sample}: {line}");
        for extension in extensions {
            assert!(list.contains(extension), "{sample}: {list}");
            assert!(line.contains(extension), "{sample}: {line}");
        }
    }
}

#[test]
fn compute_alone_runs_there_without_a_message() {
    in_child("without_rays::compute_a_picture", FAULTS);
}

#[test]
#[ignore = "run by compute_alone_runs_there_without_a_message"]
fn compute_a_picture() {
    let shaders = run::copy_of_shaders();
    run::copy(&run::root().join("tests/gpus/shaders"), shaders.path());
    // SAFETY: this is the only test of the process, and no other thread reads the environment yet.
    unsafe { std::env::set_var("SHADERS", shaders.path()) };
    let requirements = Requirements::compute().textures();
    let lines = device_lines(&requirements).expect("a device");
    assert!(lines[0].ends_with(": suitable"), "{lines:?}");
    let gpu = Gpu::new(&GpuOptions { requirements, validate: true, ..GpuOptions::default() });
    let gpu = gpu.expect("a device without ray tracing");
    assert!(!gpu.limits.has_ray_tracing());

    let scene = Scene::chess().expect("the chess set");
    let mesh = scene.instances[0].mesh;
    let orders = scene.model.meshes.iter();
    let orders = orders.map(|mesh| (0..mesh.triangles.len() as u32).rev().collect::<Vec<_>>());
    let orders: Vec<_> = orders.collect();
    let (addresses, textures, _buffers) =
        SceneOnGpu::without_levels(&gpu, &scene, &orders, None).expect("the scene's buffers");
    let pipeline = ComputePipeline::builder("without_rays")
        .compute("corners.comp")
        .workgroup(0, [8, 4])
        .binding(Binding::StorageImage)
        .binding(Binding::StorageBuffer)
        .textures(&textures)
        .push_constants::<Push>()
        .build_compute(&gpu)
        .expect("a compute pipeline");
    let count = orders[mesh].len().min(4096) as u32;
    let size = vk::Extent2D { width: count, height: 3 };
    let picture = Image::storage(&gpu, "picture", size).expect("a picture");
    let usage =
        Buffer::ADDRESSED | vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    let written = Buffer::new(&gpu, "written", 12, usage).expect("a buffer");
    let timer = Timer::new(&gpu).expect("a timer");
    gpu.submit(|cmd| {
        let descriptors = [Descriptor::StorageImage(&picture), Descriptor::StorageBuffer(&written)];
        timer.start(cmd);
        written.update(cmd, &[1u32, 2, 3])?;
        written.clear(cmd);
        // Twice, for each pair of barriers needed by a chapter without builds.
        for _ in 0..2 {
            pipeline.bind(
                cmd,
                &descriptors,
                &Push { scene: addresses, band: vk::Rect2D::from(size).into() },
            )?;
            pipeline.dispatch(cmd, size.into());
            barrier::trace_to_trace(&gpu, cmd);
            barrier::trace_to_deform(&gpu, cmd);
            barrier::deform_to_build(&gpu, cmd);
        }
        timer.stop(cmd);
        Ok(())
    })
    .expect("the device computes");
    assert!(timer.milliseconds().expect("a time") > 0.0);
    assert_eq!(written.read::<u32>().unwrap(), [2 * count; 3]);
    let mesh = &scene.model.meshes[mesh];
    let alpha = f32::from(scene.model.textures[0].rgba[3]) / 255.0;
    let seen = picture.read().expect("the picture");
    for (at, &triangle) in orders[scene.instances[0].mesh].iter().take(count as usize).enumerate() {
        for (row, &corner) in mesh.triangles[triangle as usize].iter().enumerate() {
            let position = mesh.vertices[corner as usize].position;
            assert_eq!(seen[row * count as usize + at], position.extend(alpha).to_array());
        }
    }
    let validation = gpu.validation();
    drop((pipeline, picture, written, timer, textures, _buffers, gpu));
    assert_eq!(validation.all(), [""; 0]);
}

#[test]
fn a_portable_subset_has_to_be_asked_for_and_what_is_hidden_cannot_be() {
    in_child("without_rays::open_it_otherwise", FAULTS);
}

#[test]
#[ignore = "run by a_portable_subset_has_to_be_asked_for_and_what_is_hidden_cannot_be"]
fn open_it_otherwise() {
    let requirements = Requirements::compute();
    let options = GpuOptions { requirements, validate: true, ..GpuOptions::default() };
    let gpu = Gpu::new(&options).expect("a device");
    assert_eq!(gpu.validation().all(), [""; 0]);
    let subset = khr::portability_subset::NAME;
    assert!(gpu.extensions.contains(&subset));
    let opened = |change: &dyn Fn(&mut Vec<&'static std::ffi::CStr>)| {
        let instance = &gpu.vulkan.instance;
        let mut found = device::candidates(instance, &Requirements::compute()).unwrap().remove(0);
        change(&mut found.extensions);
        // SAFETY: no object was created from it.
        device::create(instance, &found).map(|device| unsafe { device.destroy_device(None) })
    };
    opened(&|names| names.retain(|name| *name != subset)).expect("only validation minds");
    let id = "VUID-VkDeviceCreateInfo-pProperties-04451";
    let said = gpu.validation().all();
    assert!(said.len() == 1 && said[0].contains(id), "{said:?}");
    for name in [
        khr::acceleration_structure::NAME,
        khr::ray_query::NAME,
        khr::ray_tracing_position_fetch::NAME,
    ] {
        let refused = opened(&|names| names.push(name)).expect_err("it is hidden");
        assert_eq!(refused.downcast_ref(), Some(&vk::Result::ERROR_EXTENSION_NOT_PRESENT));
    }
}
