//! A machine without a loader, a driver, a device or a validation layer.

use std::fs;
use std::path::{Path, PathBuf};
#[cfg(target_os = "linux")]
use std::process::Command;

use crate::{refused_by, sample};

const SETUP: &str = "run ./setup";

/// Variables that may name a machine's drivers and their libraries.
const DRIVERS: [&str; 4] =
    ["VK_DRIVER_FILES", "VK_ADD_DRIVER_FILES", run::device::VARIABLE, "LD_LIBRARY_PATH"];

/// The two samples that create their own instance.
const SAMPLES: [&str; 2] = ["01_foundation", "02_basic"];

#[track_caller]
fn refused_with(variable: &str, value: impl AsRef<Path>, words: &[&str]) {
    for sample in SAMPLES {
        for argument in ["--headless", "--list-devices"] {
            let mut command = run::command(sample);
            // This variable also names drivers, and takes precedence.
            command.arg(argument).env_remove("VK_DRIVER_FILES").env(variable, value.as_ref());
            refused_by(command, 1, words);
        }
    }
}

#[test]
fn no_loader() {
    let words = ["no Vulkan loader (", SETUP];
    refused_with("VULKAN_LOADER", "/nonexistent", &words);
    // A file that is not a library.
    refused_with("VULKAN_LOADER", run::root().join("Cargo.toml"), &words);
}

#[test]
fn no_driver() {
    let words = ["Vulkan driver", SETUP];
    refused_with("VK_DRIVER_FILES", "/nonexistent", &words);
    refused_with("VK_ICD_FILENAMES", "/nonexistent", &words);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("driver.json");
    fs::write(&file, manifest(Path::new("/nonexistent.so"))).unwrap();
    refused_with("VK_ICD_FILENAMES", &file, &words);
    // Some loaders skip a broken manifest, others fail.
    fs::write(&file, "{").unwrap();
    refused_with("VK_ICD_FILENAMES", &file, &["Vulkan", SETUP]);
}

#[test]
fn no_device_with_ray_tracing() {
    let driver = driver();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("driver.json");
    fs::write(&file, manifest(&driver)).unwrap();
    let lacks = ["A card of 2014", "lacks VK_KHR_", "VK_KHR_ray_tracing_pipeline"];
    for sample in SAMPLES {
        let command = |argument: &str| {
            let mut command = run::command(sample);
            command.arg(argument).env_remove("VK_DRIVER_FILES").env("VK_ICD_FILENAMES", &file);
            command
        };
        refused_by(command("--headless"), 1, &["no device can run this: 0: ", SETUP]);
        refused_by(command("--headless"), 1, &lacks);
        let mut named = command("--headless");
        named.args(["--device", "card"]);
        refused_by(named, 1, &lacks);
        let told = command("--list-devices").output().unwrap();
        assert!(told.status.success());
        let told = String::from_utf8(told.stdout).unwrap();
        assert!(lacks.iter().all(|word| told.contains(word)), "{told}");

        for argument in ["--headless", "--list-devices"] {
            let mut without = command(argument);
            without.env("DRIVER_WITHOUT_DEVICE", "1");
            refused_by(without, 1, &["no Vulkan device", SETUP]);
        }
    }
}

/// A driver's manifest, in the loader's format.
fn manifest(library: &Path) -> String {
    let driver = serde_json::json!({ "library_path": library, "api_version": "1.3.0" });
    serde_json::json!({ "file_format_version": "1.0.0", "ICD": driver }).to_string()
}

/// The library of `driver/`; this test depends on it, so cargo puts it in the same folder.
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
    // As in a service: no HOME, PATH or language, only the drivers for tests.
    let folder = tempfile::tempdir().unwrap();
    let drivers = DRIVERS.iter().filter_map(|name| Some((name, std::env::var_os(name)?)));
    let status = sample().env_clear().envs(drivers).current_dir(&folder).status().unwrap();
    assert!(status.success());
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
}

#[test]
fn no_compiler_for_another_gpu() {
    let mut command = sample();
    // The variable replaces the folders in which drivers are found, so the device's own driver has to be
    // named.
    command.args(["--compile-for", "navi31"]).env("XDG_DATA_DIRS", "/nonexistent");
    let drivers = ["/etc", "/usr/local/share", "/usr/share"]
        .map(|folder| Path::new(folder).join("vulkan/icd.d"))
        .iter()
        .filter_map(|folder| folder.read_dir().ok())
        .flat_map(|files| files.map(|file| file.expect("a file has a name").path()))
        .collect::<Vec<_>>();
    if drivers.iter().any(|driver| driver.starts_with("/etc")) {
        return println!("not tried: drivers in /etc cannot be hidden");
    }
    if ["VK_DRIVER_FILES", run::device::VARIABLE]
        .iter()
        .all(|name| std::env::var_os(name).is_none())
    {
        command.env("VK_DRIVER_FILES", std::env::join_paths(drivers).expect("plain names"));
    }
    refused_by(command, 1, &["(RADV), which is not installed", SETUP]);
}

#[cfg(target_os = "linux")]
#[test]
fn no_intel_card_to_compile_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = sample();
    command.args(["--compile-for", "dg2"]).env("XDG_CACHE_HOME", folder.path());
    let words = [
        "cannot compile for dg2: what stands in for Intel's cards is not built",
        "tests/intel/build",
    ];
    refused_by(command, 1, &words);
}

/// A machine whose only driver is outside the loader's folders, so that a variable has to name it.
#[cfg(target_os = "linux")]
#[test]
fn a_driver_that_only_a_variable_names_is_enough_for_these_tests() {
    let folder = tempfile::tempdir().unwrap();
    let named = folder.path().join("named.json");
    let Some(manifest) = run::device::manifest() else { return };
    fs::copy(&manifest, &named).unwrap();
    // Only this shell sees the mount.
    let script = "mount -t tmpfs none \"$1\" || exit 77; shift; exec \"$@\"";
    let mut command = Command::new("unshare");
    command.args(["--map-root-user", "--mount", "sh", "-c", script, "sh"]);
    command.arg(manifest.parent().expect("a folder"));
    command.arg(std::env::current_exe().expect("a running program has a file"));
    command.args(["--exact", "machine::no_environment_at_all"]);
    command.arg("machine::no_compiler_for_another_gpu");
    command.env("GPU", "1").env("VK_DRIVER_FILES", &named).env_remove(run::device::VARIABLE);
    let output = command.output().unwrap();
    let [told, errors] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    match output.status.code() {
        Some(77 | 1) if told.is_empty() => println!("not tried: {errors}"),
        _ => assert!(told.contains("2 passed"), "{told:.3000}{errors:.3000}"),
    }
}
