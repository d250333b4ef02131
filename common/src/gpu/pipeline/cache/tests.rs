//! Contents of the pipeline cache file, and the compile time it saves.

use std::process::Command;
use std::time::Instant;

use instruments::compile_for::{manifest, ways};
use serde_json::json;

use super::*;
use crate::gpu::pipeline::desc::{Binding, Group, PipelineDesc, Stage};
use crate::gpu::{Gpu, GpuOptions, Requirements, Vulkan, device, shader};

/// A device, and what it says of itself.
fn gpu() -> (Gpu, vk::PhysicalDeviceProperties) {
    let requirements = Requirements::ray_tracing();
    let gpu = Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).unwrap();
    let properties = gpu.properties;
    (gpu, properties)
}

/// Opens the cache, closes it again, and returns the number of bytes passed to the driver.
fn run(folder: &Path, most: usize, gpu: &Gpu, of: &vk::PhysicalDeviceProperties) -> usize {
    let mut cache = PipelineCache::open(Some(folder), &gpu.device, of);
    cache.most = most;
    assert_ne!(cache.handle, vk::PipelineCache::null());
    cache.close(&gpu.device);
    cache.known.len()
}

/// True if the driver's data begins with the whole header that Vulkan prescribes. That of Mesa 26.2.6's llvmpipe
/// ends after 20 of 32 bytes, so its origin cannot be checked, and it is never passed to the driver.
fn has_whole_header(gpu: &Gpu, of: &vk::PhysicalDeviceProperties) -> bool {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), MOST, gpu, of);
    read_sealed(&only_file(folder.path())).unwrap().starts_with(&header(of))
}

fn only_file(folder: &Path) -> PathBuf {
    let files: Vec<_> = folder.read_dir().unwrap().map(|file| file.unwrap().path()).collect();
    assert_eq!(files.len(), 1, "{files:?}");
    files[0].clone()
}

#[test]
fn a_second_start_has_what_the_first_has_left() {
    let (gpu, properties) = gpu();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("made when there is something to keep");
    assert_eq!(run(&folder, MOST, &gpu, &properties), 0);
    let kept = run(&folder, MOST, &gpu, &properties);
    if !has_whole_header(&gpu, &properties) {
        return assert_eq!(kept, 0);
    }
    assert!(kept >= 32, "{kept} bytes");
    assert_eq!(fs::metadata(only_file(&folder)).unwrap().len(), kept as u64 + 8);
}

#[test]
fn a_damaged_file_is_ignored_and_replaced() {
    let (gpu, properties) = gpu();
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), MOST, &gpu, &properties);
    let file = only_file(folder.path());
    let good = fs::read(&file).unwrap();
    let cut = good[..good.len() / 2].to_vec();
    let mut flipped = good.clone();
    flipped[20] ^= 1;
    for damaged in [Vec::new(), vec![0; 40], cut, flipped] {
        fs::write(&file, damaged).unwrap();
        assert_eq!(run(folder.path(), MOST, &gpu, &properties), 0);
        assert_eq!(fs::read(&file).unwrap(), good);
    }
}

#[test]
fn what_another_driver_has_left_is_not_shown_to_this_one() {
    let (gpu, properties) = gpu();
    let folder = tempfile::tempdir().unwrap();
    // Under the name of another driver, the file contains what this one has left.
    let mut other = properties;
    other.pipeline_cache_uuid[0] ^= 1;
    for _ in 0..2 {
        assert_eq!(run(folder.path(), MOST, &gpu, &other), 0);
        only_file(folder.path());
    }
}

#[test]
fn what_has_grown_too_large_is_begun_anew() {
    let (gpu, properties) = gpu();
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), MOST, &gpu, &properties);
    let known = run(folder.path(), 16, &gpu, &properties);
    assert_eq!(known >= 32, has_whole_header(&gpu, &properties), "{known} bytes");
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
}

/// RADV compiles for a GPU that is not installed: the second process finds what the first has compiled.
#[test]
fn a_gpu_s_compiler_does_not_do_again_what_an_earlier_run_has_done() {
    let folder = tempfile::tempdir().unwrap();
    let manifest = manifest("navi31").unwrap_or_else(|error| panic!("{error}"));
    let by = |way: Vec<_>| -> Option<(f64, String)> {
        let output = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "gpu::pipeline::cache::tests::make_a_pipeline_for_radv"])
            .args(["--ignored", "--nocapture"])
            .env("KEPT_IN", folder.path())
            .envs(way)
            .env("VK_DRIVER_FILES", &manifest)
            .env_remove("VK_ICD_FILENAMES")
            // Mesa has its own cache; only this project's may count.
            .env("MESA_SHADER_CACHE_DIR", folder.path().join("mesa"))
            .output()
            .unwrap();
        let told = [output.stdout, output.stderr].map(|t| String::from_utf8_lossy(&t).into_owned());
        let _ = fs::remove_dir_all(folder.path().join("mesa"));
        let line =
            told[0].lines().find_map(|line| line.split_once("made in ")?.1.split_once(" ms by "));
        if line.is_none() {
            println!("{told:?}");
        }
        line.map(|(time, driver)| (time.parse().unwrap(), driver.to_owned()))
    };
    let timed = || {
        ways("navi31")
            .expect("AMD's ways")
            .into_iter()
            .find_map(by)
            .expect("Mesa stands in for a card")
    };
    let (first, driver) = timed();
    let file = only_file(folder.path());
    let kept = fs::metadata(&file).unwrap().len();
    let (second, _) = timed();
    println!("{first:.1} ms, then {second:.1} ms with {kept} bytes");
    if let Some(folder) = std::env::var_os("FIGURES") {
        // As written by `figures::give_timed`, which belongs to tests that depend on this crate.
        let given = json!({ "timed": true, "device": "RADV", "driver": driver,
                            "values": { "first": first, "second": second } });
        fs::create_dir_all(Path::new(&folder).join("needs")).unwrap();
        fs::write(Path::new(&folder).join("needs/starts.json"), given.to_string()).unwrap();
    }
    assert!(second < first / 2.0, "{first} ms, then {second} ms with {kept} bytes");
    let mut bytes = fs::read(&file).unwrap();
    bytes[100] ^= 1;
    fs::write(&file, bytes).unwrap();
    let (third, _) = timed();
    assert!(second < third / 2.0, "{second} ms, then {third} ms with a damaged file");
}

#[test]
#[ignore = "run by a_gpu_s_compiler_does_not_do_again_what_an_earlier_run_has_done"]
fn make_a_pipeline_for_radv() {
    let requirements = Requirements::ray_tracing().textures();
    let vulkan = Vulkan::new(None, None).unwrap();
    let chosen = device::candidates(&vulkan.instance, &requirements).unwrap().remove(0);
    let options = GpuOptions { requirements, ..GpuOptions::default() };
    let gpu = Gpu::open(vulkan, chosen, options).unwrap();
    let folder = std::env::var("KEPT_IN").unwrap();
    let mut cache = PipelineCache::open(Some(Path::new(&folder)), &gpu.device, &gpu.properties);
    let stages = ["camera.rgen", "sky.rmiss", "shade.rchit"].map(|file| {
        let shader = shader::compile(&format!("26_leaving_a_surface/{file}")).unwrap();
        Stage { path: shader.path, stage: shader.stage.as_raw(), words: shader.spirv }
    });
    let general = |general| Group { general, ..Group::default() };
    let kind = vk::RayTracingShaderGroupTypeKHR::TRIANGLES_HIT_GROUP.as_raw();
    let hit = Group { kind, closest_hit: 2, ..Group::default() };
    let desc = PipelineDesc {
        name: "26".to_owned(),
        stages: stages.into(),
        groups: vec![general(0), general(1), hit],
        bindings: vec![Binding::AccelerationStructure, Binding::StorageImage],
        push_size: 128,
        recursion: 1,
        ..PipelineDesc::default()
    };
    let textures = crate::gpu::TextureTable::layout(&gpu, 1).unwrap();
    let (_, layout) = desc.layouts(&gpu, Some(textures)).unwrap();
    let start = Instant::now();
    desc.create(&gpu, layout, cache.handle).unwrap();
    println!("made in {} ms by {}, RDNA3", start.elapsed().as_secs_f64() * 1e3, gpu.driver);
    // The process frees the rest: nothing runs on a GPU that is not installed.
    cache.close(&gpu.device);
    std::mem::forget(gpu);
}
