//! Every sample on the narrowest device Vulkan allows: a layer hides everything optional.

use std::process::Output;

use common::gpu::{ADDRESS_ALIGNMENT, Buffer, Gpu, GpuOptions, Requirements, device_lines};
use common::scene::input_usage;
use run::layer::{Layer, in_child};

use ash::vk;

// ANCHOR: unsuitable
/// The samples for which the narrowest device will not do, and the limits that they ask for.
const UNSUITABLE: [(&str, &str); 5] = [
    ("10_position_fetch", "lacks VK_KHR_ray_tracing_position_fetch"),
    ("16_ray_query", "lacks VK_KHR_ray_query"),
    ("17_ray_query_raster", "lacks VK_KHR_ray_query"),
    ("20_wireframe", "lacks VK_KHR_ray_tracing_position_fetch"),
    // Its picture shows how far a rung is off from error-free sums, which need their rounding declared.
    ("24_accuracy", "lacks shaderRoundingModeRTEFloat32, shaderSignedZeroInfNanPreserveFloat32"),
];
// ANCHOR_END: unsuitable

// ANCHOR: refused
/// Requests to suitable samples that the narrowest device refuses: the arguments, the limit, and words of the line
/// that says so.
const REFUSED: [(&str, [&str; 2], &str, &str); 3] = [
    (
        "06_reflection",
        ["--set", "method=recursive"],
        "maxRayRecursionDepth 1",
        "needs a recursion depth of 2",
    ),
    (
        "25_scene_effects",
        ["--set", "measure costs=on"],
        "timestampValidBits 0",
        "whose queue has no timestamps",
    ),
    ("02_basic", ["--size", "5000x4"], "maxImageDimension2D 4096", "at most 4096 a side"),
];
// ANCHOR_END: refused

// ANCHOR: features
/// The features without which no device is suitable, and the samples that do without.
const FEATURES: [(&str, &[&str]); 8] = [
    ("accelerationStructure", &["30_own_tree"]),
    ("rayTracingPipeline", &["30_own_tree"]),
    ("bufferDeviceAddress", &[]),
    ("synchronization2", &[]),
    ("scalarBlockLayout", &["01_foundation"]),
    ("runtimeDescriptorArray", &["01_foundation", "24_accuracy"]),
    ("shaderSampledImageArrayNonUniformIndexing", &["01_foundation", "24_accuracy"]),
    ("descriptorBindingSampledImageUpdateAfterBind", &["01_foundation", "24_accuracy"]),
];
// ANCHOR_END: features

/// Further settings of samples that need more of a device: other stages, larger tables, more memory.
const ALSO: [(&str, &[&str]); 9] = [
    ("03_any_hit", &["--set", "mode=all hits"]),
    ("03_any_hit", &["--set", "mode=random", "--set", "no duplicates=on"]),
    ("07_multi_closest_hit", &["--set", "scale=2"]),
    ("42_distant_spheres", &["--set", "sphere rung=host c"]),
    ("21_heightfield", &["--set", "rung=relaxed"]),
    ("22_solids", &["--set", "show=normal"]),
    ("25_scene_effects", &["--set", "scene=everything", "--set", "pipeline=everything"]),
    ("25_scene_effects", &["--set", "scene=lake"]),
    ("30_own_tree", &["--set", "tree=device"]),
];

/// The standard output of a successful run without messages, including those of validation.
#[track_caller]
pub fn quiet(what: &str, output: Output) -> String {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && errors.is_empty(), "{what}: {errors:.2000}");
    String::from_utf8(output.stdout).expect("text")
}

/// The report of a small headless run.
#[track_caller]
pub fn runs(narrow: &Layer, sample: &str, arguments: &[&str]) -> serde_json::Value {
    let mut command = narrow.command(sample);
    command.args(["--headless", "--validate", "--report", "-"]).args(arguments);
    if !arguments.contains(&"--size") {
        command.args(["--size", "24x16"]);
    }
    let report = quiet(sample, command.output().expect("the sample starts"));
    let report: serde_json::Value = serde_json::from_str(&report).expect("the report is JSON");
    assert!(report["device"].as_str().unwrap().starts_with("narrow "), "{sample}: {report}");
    report
}

#[test]
fn every_sample_runs_on_the_narrowest_device() {
    let narrow = Layer::minimum_limits("");
    for sample in run::chapters() {
        if let Some((_, lacks)) = UNSUITABLE.iter().find(|(name, _)| *name == sample) {
            let mut command = narrow.command(&sample);
            let (code, line) = run::refusal(command.arg("--headless").output().expect("it starts"));
            assert_eq!(code, 1);
            assert!(line.contains("no device can run this: 0: narrow "), "{line}");
            assert!(line.contains(lacks), "{line}");
            // The layer also sees the barriers of samples that trace without a pipeline.
            if !lacks.contains("Float32") {
                runs(&Layer::minimum_limits("queries"), &sample, &["--frames", "3"]);
            }
            continue;
        }
        // Each frame reads or overwrites the results of the previous one, so that the layer sees the barriers
        // between frames.
        let report = runs(&narrow, &sample, &["--frames", "3"]);
        // There are no timestamps, so the host's clock is used.
        assert!(report["gpu_milliseconds"]["median"].as_f64().unwrap() > 0.0, "{sample}");
    }
}

#[test]
fn whatever_else_a_sample_shows_runs_there_too() {
    let narrow = Layer::minimum_limits("");
    for (sample, settings) in ALSO {
        runs(&narrow, sample, settings);
    }
}

#[test]
fn what_asks_for_more_than_is_promised_is_refused_in_one_line() {
    let narrow = Layer::minimum_limits("");
    for (sample, arguments, limit, words) in REFUSED {
        let mut command = narrow.command(sample);
        command.args(["--headless", "--validate"]).args(arguments);
        let (_, line) = run::refusal(command.output().expect("the sample starts"));
        assert!(line.contains(words), "{sample}, {limit}: {line}");
    }
}

/// A chapter for each set of requirements; 12 stands for all the others.
const KINDS: [&str; 4] = ["01_foundation", "12_infinite_plane", "24_accuracy", "30_own_tree"];

#[test]
fn a_feature_that_is_missing_refuses_a_device_when_devices_are_chosen() {
    each_feature_is_asked_for_by(&KINDS.map(str::to_owned));
}

#[test]
#[ignore = "nightly: every feature, every chapter; quick: narrowest::a_feature_that_is_missing_refuses_a_device_when_devices_are_chosen"]
fn so_it_does_for_every_chapter() {
    each_feature_is_asked_for_by(&run::chapters());
}

fn each_feature_is_asked_for_by(samples: &[String]) {
    let narrow = Layer::minimum_limits("");
    for sample in samples {
        let mut list = narrow.command(sample);
        let list = quiet(sample, list.arg("--list-devices").output().expect("it starts"));
        let is_suitable = UNSUITABLE.iter().all(|(name, _)| name != sample);
        assert_eq!(list.trim_end().ends_with(": suitable"), is_suitable, "{sample}: {list}");
    }
    for (feature, without) in FEATURES {
        let narrow = Layer::minimum_limits(&format!("without={feature}"));
        for sample in samples {
            let mut list = narrow.command(sample);
            let list = quiet(sample, list.arg("--list-devices").output().expect("it starts"));
            let lacks = list.contains(&format!("feature {feature}"));
            assert_eq!(!lacks, without.contains(&sample.as_str()), "{sample}: {list}");
        }
    }
}

/// The laboratory needs no more than the others, and reports what a rung lacks.
#[test]
fn the_laboratory_asks_the_rungs_that_the_narrowest_device_can_do() {
    let narrow = Layer::minimum_limits("");
    let folder = tempfile::tempdir().unwrap();
    let mut command = narrow.command("24_accuracy");
    command.args(["--headless", "--validate", "--only", "sphere", "--rays", "8", "--rounds", "1"]);
    let output = command.arg("--measure").arg(folder.path()).output().expect("it starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    assert!(!errors.contains("validation"), "{errors}");
    let measured = std::fs::read_to_string(folder.path().join("accuracy.json")).unwrap();
    assert!(measured.contains("does not offer shaderRoundingModeRTEFloat32"), "{measured:.1000}");
}

/// The same holds for its atlas, row by row; all other rows need no more than the promised limits.
#[test]
fn the_atlas_asks_what_the_narrowest_device_can_do() {
    let narrow = Layer::minimum_limits("");
    let folder = tempfile::tempdir().unwrap();
    let draw = |arguments: &[&str]| {
        let mut command = narrow.command("24_accuracy");
        command.args(["--headless", "--validate", "--rays", "8"]).args(arguments);
        command.arg("--atlas").arg(folder.path()).output().expect("it starts")
    };
    quiet("the atlas", draw(&[]));
    let atlas = std::fs::read_to_string(folder.path().join("atlas.json")).unwrap();
    let atlas: serde_json::Value = serde_json::from_str(&atlas).unwrap();
    let unasked = |row: &&serde_json::Value| !row["unavailable"].is_null();
    let unasked: Vec<_> = atlas["rows"].as_array().unwrap().iter().filter(unasked).collect();
    assert_eq!(unasked.len(), 1, "{unasked:?}");
    let why = "the device does not offer VK_KHR_ray_tracing_position_fetch";
    assert_eq!((&unasked[0]["row"], &unasked[0]["unavailable"]), (&"corners".into(), &why.into()));
    let (code, line) = run::refusal(draw(&["--traversal", "software"]));
    let why = "--traversal software cannot be had: ";
    assert!(code == 1 && line.contains(why) && line.contains("shaderRounding"), "{line}");
}

#[test]
fn a_card_without_graphics_traces_without_a_window() {
    let narrow = Layer::minimum_limits("compute-only");
    for sample in ["01_foundation", "02_basic"] {
        runs(&narrow, sample, &[]);
    }
}

/// A sample that draws, or makes mip levels by blits, needs a graphics queue, and reports it together with
/// everything else that is missing.
#[test]
fn a_card_without_graphics_is_refused_by_what_draws() {
    let lacks = |sample: &str, faults: &str, what: &str| {
        let narrow = Layer::minimum_limits(faults);
        let mut list = narrow.command(sample);
        quiet(sample, list.arg("--list-devices").output().expect("it starts")).contains(what)
    };
    for sample in ["17_ray_query_raster", "19_ray_cones"] {
        assert!(lacks(sample, "compute-only", "a queue with graphics"), "{sample}");
        assert!(!lacks(sample, "", "a queue with graphics"), "{sample}");
    }
    assert!(lacks("17_ray_query_raster", "without=dynamicRendering", "feature dynamicRendering"));
    assert!(!lacks("17_ray_query_raster", "", "feature dynamicRendering"));
}

/// The layer's counts for a run of a sample: submissions, and allocations in device memory, in host memory,
/// and in device memory the host can map.
#[track_caller]
fn counted(faults: &str, sample: &str, arguments: &[&str]) -> [u32; 4] {
    counted_and_told(faults, sample, arguments).0
}

/// The same, and the sample's own report.
#[track_caller]
fn counted_and_told(
    faults: &str,
    sample: &str,
    arguments: &[&str],
) -> ([u32; 4], serde_json::Value) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("told");
    let narrow = Layer::minimum_limits(&format!("{faults},tell={}", file.display()));
    let report = runs(&narrow, sample, arguments);
    let told = std::fs::read_to_string(&file).expect("the layer tells");
    let numbers: Vec<u32> = told.split(' ').map(|number| number.parse().unwrap()).collect();
    (numbers.try_into().expect("four numbers"), report)
}

/// A picture of one row is one band, and a band is one submission. A moving camera's uploads are part of it:
/// nothing else is submitted and waited for.
#[test]
fn a_frame_from_elsewhere_is_one_submission() {
    // Their hosts compute something from the camera or the time, or have a structure of their own; 02 has
    // nothing like that.
    frames_are_submissions(&[
        "02_basic",
        "12_infinite_plane",
        "14_animation",
        "39_far_from_origin",
    ]);
}

#[test]
#[ignore = "nightly: every chapter; quick: narrowest::a_frame_from_elsewhere_is_one_submission"]
fn so_it_is_in_every_chapter() {
    let mut samples = run::chapters_on_the_framework();
    samples.retain(|name| UNSUITABLE.iter().all(|(unsuitable, _)| name != unsuitable));
    frames_are_submissions(&samples);
}

fn frames_are_submissions<Name: AsRef<str>>(samples: &[Name]) {
    let moving =
        ["--compare", "camera eye=-5.6,2.7,8.2|-5.5,2.7,8.2", "--size", "24x1", "--frames"];
    let mut samples: Vec<_> = samples.iter().map(|name| (name.as_ref(), vec![])).collect();
    // Its host computes a number for each sphere from the position of the eye.
    samples.push(("42_distant_spheres", vec!["--set", "sphere rung=host c"]));
    for (sample, settings) in samples {
        let submissions = |frames: &str| {
            let arguments = [&moving[..], &[frames], &settings[..]].concat();
            let ([submissions, ..], report) = counted_and_told("", sample, &arguments);
            let frames = report["comparison"]["frames"].as_u64().expect("it counts them");
            submissions as i64 - frames as i64
        };
        let (few, many) = (submissions("1"), submissions("3"));
        assert_eq!(few, many, "{sample} submits more often than it draws");
    }
}

/// 01 has vertices, instances and a table written by the host, and a picture read by the host.
#[test]
fn the_foundation_s_uploads_lie_in_the_device_where_the_host_can_write_there() {
    let [_, device, host, both] = counted("", "01_foundation", &[]);
    assert_eq!([host, both], [4, 0], "memory of the host must do");
    let [_, same, host, both] = counted("bar", "01_foundation", &[]);
    assert_eq!([host, both], [1, 3], "only the picture is read by the host");
    assert_eq!(device, same);
}

#[test]
fn a_list_of_hits_that_has_no_room_is_refused_with_what_would_fit() {
    let refused = |faults: &str, size: &str, words: [&str; 2]| {
        let narrow = Layer::minimum_limits(faults);
        let mut command = narrow.command("03_any_hit");
        let mode = ["--set", "mode=all hits"];
        let output = command.args(["--headless", "--validate", "--size", size]).args(mode).output();
        let (code, line) = run::refusal(output.expect("the sample starts"));
        assert_eq!(code, 1);
        assert!(words.iter().all(|word| line.contains(word)), "{line}");
    };
    // Limited by maxBufferSize and maxMemoryAllocationSize, 2^30 bytes.
    let size = "a list of all hits takes 384 bytes per pixel";
    refused("", "3000x1000", [size, "room for 2796202 pixels, not for 3000000"]);
    // Limited by the available memory.
    refused("heap=268435456", "1000x700", [size, "room for 699050 pixels, not for 700000"]);
}

/// In a table that is written before it is bound, a device may support no more than 16 textures.
#[test]
fn a_scene_has_more_textures_than_a_device_may_bind_in_the_common_way() {
    const TEXTURES: usize = 40;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (mut model, mut materials) = ("mtllib a.mtl\n".to_owned(), String::new());
    for i in 0..TEXTURES {
        let (x, next) = (i as f32 / 10.0, 3 * i + 1);
        model += &format!("v {x} 0 0\nv {x} 1 0\nv {} 0 0\nvt 0 0\nvt 0 1\nvt 1 0\n", x + 0.1);
        let corner = |k: usize| format!("{0}/{0}", next + k);
        model += &format!("usemtl m{i}\nf {} {} {}\n", corner(0), corner(1), corner(2));
        materials += &format!("newmtl m{i}\nmap_Kd {i}.png\n");
        let color = image::Rgb([255 - i as u8, i as u8, 0]);
        image::RgbImage::from_pixel(1, 1, color)
            .save(folder.path().join(format!("{i}.png")))
            .unwrap();
    }
    std::fs::write(folder.path().join("a.obj"), model).unwrap();
    std::fs::write(folder.path().join("a.mtl"), materials).unwrap();
    let model = folder.path().join("a.obj");
    runs(
        &Layer::minimum_limits(""),
        "02_basic",
        &["--scene", model.to_str().expect("a plain path")],
    );
}

// The tests below call Vulkan themselves: each is run again in a child with the layer.

#[test]
fn without_64_bit_floats_the_worst_arithmetic_is_left_out() {
    in_child("narrowest::have_no_64_bit_floats", "");
}

#[test]
#[ignore = "run by without_64_bit_floats_the_worst_arithmetic_is_left_out"]
fn have_no_64_bit_floats() {
    assert!(!run::has_worst_arithmetic());
    let (code, line) = run::refused("02_basic", &["--headless", "--arithmetic", "worst"]);
    assert!(code == 1 && line.contains("lacks feature shaderFloat64"), "{line}");
}

#[test]
fn validation_holds_programs_to_the_narrow_limits() {
    in_child("narrowest::violate_the_narrow_limits", "");
}

#[test]
#[ignore = "run by validation_holds_programs_to_the_narrow_limits"]
fn violate_the_narrow_limits() {
    let requirements = Requirements::ray_tracing();
    let options = GpuOptions { requirements, validate: true, ..GpuOptions::default() };
    let gpu = Gpu::new(&options).expect("a device");
    assert_eq!(gpu.validation().all(), [""; 0]);
    assert_eq!((gpu.limits.max_ray_recursion_depth, gpu.limits.has_timestamps()), (1, false));
    let device = &gpu.device;
    let stage = vk::ShaderStageFlags::RAYGEN_KHR;
    let said = |id: &str| gpu.validation().all().iter().any(|message| message.contains(id));
    // SAFETY: the device below supports all of this, and every object is destroyed.
    unsafe {
        let ranges = [vk::PushConstantRange::default().stage_flags(stage).size(132)];
        let info = vk::PipelineLayoutCreateInfo::default().push_constant_ranges(&ranges);
        let layout = device.create_pipeline_layout(&info, None).expect("a layout");
        device.destroy_pipeline_layout(layout, None);
        assert!(said("VUID-VkPushConstantRange-size-00298"), "{:?}", gpu.validation().all());

        let slots = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .descriptor_count(17)
            .stage_flags(vk::ShaderStageFlags::ALL)];
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&slots);
        let set = device.create_descriptor_set_layout(&info, None).expect("a set layout");
        let sets = [set];
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        let layout = device.create_pipeline_layout(&info, None).expect("a layout");
        device.destroy_pipeline_layout(layout, None);
        device.destroy_descriptor_set_layout(set, None);
        let id = "VUID-VkPipelineLayoutCreateInfo-descriptorType-03016";
        assert!(said(id), "{:?}", gpu.validation().all());
    }
}

#[test]
fn a_limit_that_is_too_low_refuses_a_device_when_devices_are_chosen() {
    in_child("narrowest::ask_for_more_than_is_promised", "");
}

#[test]
#[ignore = "run by a_limit_that_is_too_low_refuses_a_device_when_devices_are_chosen"]
fn ask_for_more_than_is_promised() {
    let line = |wanted: Requirements| device_lines(&wanted).expect("a device").remove(0);
    let promised = line(Requirements::ray_tracing());
    assert!(promised.ends_with(": suitable"), "{promised}");
    let more = line(Requirements::ray_tracing().recursion(2).push_constants(144));
    let lacks = ": lacks maxRayRecursionDepth 2 (it has 1), maxPushConstantsSize 144 (it has 128)";
    assert!(more.ends_with(lacks), "{more}");
}

/// Maps device memory, like a program that skips the copy through host memory.
fn map_memory_of_the_device() -> (Result<(), vk::Result>, Vec<String>) {
    let requirements = Requirements::ray_tracing();
    let options = GpuOptions { requirements, validate: true, ..GpuOptions::default() };
    let gpu = Gpu::new(&options).expect("a device");
    // As requested by a programmer who only knows the software driver: the first type in device memory.
    // SAFETY: the device is alive, and the allocation is freed.
    let mapped = unsafe {
        let types = gpu.vulkan.instance.get_physical_device_memory_properties(gpu.physical_device);
        let own = vk::MemoryPropertyFlags::DEVICE_LOCAL;
        let types = types.memory_types_as_slice();
        let own = types.iter().position(|kind| kind.property_flags.contains(own)).expect("memory");
        let info =
            vk::MemoryAllocateInfo::default().allocation_size(64).memory_type_index(own as u32);
        let memory = gpu.device.allocate_memory(&info, None).expect("64 bytes");
        let mapped = gpu.device.map_memory(memory, 0, 64, vk::MemoryMapFlags::empty()).map(drop);
        gpu.device.free_memory(memory, None);
        mapped
    };
    (mapped, gpu.validation().all())
}

/// The software driver allows it, because all of its memory is host memory.
#[test]
fn memory_of_the_device_is_not_the_host_s() {
    if run::device::is_software() {
        assert_eq!(map_memory_of_the_device(), (Ok(()), vec![]));
    }
    in_child("narrowest::map_what_is_the_device_s_alone", "");
}

#[test]
#[ignore = "run by memory_of_the_device_is_not_the_host_s"]
fn map_what_is_the_device_s_alone() {
    let (mapped, said) = map_memory_of_the_device();
    assert_eq!(mapped, Err(vk::Result::ERROR_MEMORY_MAP_FAILED));
    let id = "VUID-vkMapMemory-memory-00682";
    assert!(said.len() == 1 && said[0].contains(id), "{said:?}");
}

/// Shaders promise alignments of addresses, and builds need some, that a driver does not give every buffer.
#[test]
fn addressed_buffers_are_aligned_where_the_driver_does_not_ask_for_it() {
    in_child("narrowest::address_buffers_of_odd_sizes", "loose-buffers");
}

#[test]
#[ignore = "run by addressed_buffers_are_aligned_where_the_driver_does_not_ask_for_it"]
fn address_buffers_of_odd_sizes() {
    let requirements = Requirements::ray_tracing();
    let gpu = Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).expect("a device");
    let buffers: Vec<_> = [4u32, 12, 20, 8, 36, 4]
        .map(|bytes| {
            let data = vec![0u8; bytes as usize];
            Buffer::with_data(&gpu, "odd", &data, input_usage()).expect("a buffer")
        })
        .into();
    for buffer in &buffers {
        let (address, size) = (buffer.address, buffer.size);
        assert_eq!(address % ADDRESS_ALIGNMENT, 0, "{size} bytes at {address:#x}");
    }
}
