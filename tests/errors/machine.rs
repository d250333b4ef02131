//! A machine that lacks something: loader, driver, device, validation layer.

use std::fs;
use std::path::{Path, PathBuf};

use crate::{refused_by, run, sample};

const SETUP: &str = "run ./setup";

#[track_caller]
fn refused_with(variable: &str, value: impl AsRef<Path>, words: &[&str]) {
    for argument in ["--headless", "--list-devices"] {
        let mut command = run::command(crate::SAMPLE);
        command.arg(argument).env(variable, value.as_ref());
        refused_by(command, 1, words);
    }
}

#[test]
fn no_loader() {
    let words = ["no Vulkan loader (", SETUP];
    refused_with("VULKAN_LOADER", "/nonexistent", &words);
    // A file that is no library at all.
    refused_with("VULKAN_LOADER", run::root().join("Cargo.toml"), &words);
}

#[test]
fn no_driver() {
    let words = ["no Vulkan driver: ", SETUP];
    refused_with("VK_DRIVER_FILES", "/nonexistent", &words);
    refused_with("VK_ICD_FILENAMES", "/nonexistent", &words);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("driver.json");
    fs::write(&file, manifest(Path::new("/nonexistent.so"))).unwrap();
    refused_with("VK_ICD_FILENAMES", &file, &words);
    // Some loaders pass over a broken manifest, some fail.
    fs::write(&file, "{").unwrap();
    refused_with("VK_ICD_FILENAMES", &file, &["Vulkan", SETUP]);
}

#[test]
fn no_device_with_ray_tracing() {
    let driver = driver();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("driver.json");
    fs::write(&file, manifest(&driver)).unwrap();
    let mut command = sample();
    command.env("VK_ICD_FILENAMES", &file);
    let lacks = "0: A card of 2014 (discrete GPU; A driver 1.0): lacks \
                 VK_KHR_acceleration_structure";
    refused_by(
        command,
        1,
        &["no device can run this: ", lacks, "VK_KHR_ray_tracing_pipeline", SETUP],
    );
    let mut command = sample();
    command.args(["--device", "card"]).env("VK_ICD_FILENAMES", &file);
    refused_by(command, 1, &["device 'card' cannot run this: ", lacks]);

    let mut command = run::command(crate::SAMPLE);
    command.arg("--list-devices").env("VK_ICD_FILENAMES", &file);
    let told = String::from_utf8(command.output().unwrap().stdout).unwrap();
    assert!(told.starts_with(lacks), "{told}");

    let mut command = sample();
    command.env("VK_ICD_FILENAMES", &file).env("DRIVER_WITHOUT_DEVICE", "1");
    refused_by(command, 1, &["no Vulkan device", SETUP]);
}

/// A driver's manifest, as the loader reads it.
fn manifest(library: &Path) -> String {
    let driver = serde_json::json!({ "library_path": library, "api_version": "1.3.0" });
    serde_json::json!({ "file_format_version": "1.0.0", "ICD": driver }).to_string()
}

/// The library of `driver/`, on which this test depends: cargo puts it beside.
fn driver() -> PathBuf {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let test = std::env::current_exe().expect("a running program has a file");
    test.with_file_name(format!("{DLL_PREFIX}driver_without_ray_tracing{DLL_SUFFIX}"))
}

#[test]
fn no_validation_layer() {
    let mut command = sample();
    command.arg("--validate").env("VK_LAYER_PATH", "/nonexistent");
    refused_by(command, 1, &["--validate needs VK_LAYER_KHRONOS_validation", SETUP]);
}

#[test]
fn no_environment_at_all() {
    // Neither HOME nor PATH nor a language: as from a service.
    let folder = tempfile::tempdir().unwrap();
    let status = sample().env_clear().current_dir(&folder).status().unwrap();
    assert!(status.success());
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
}
