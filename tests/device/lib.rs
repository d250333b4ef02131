//! The device that tests run on: the software driver alone, unless `GPU` in the environment names another.
//!
//! `GPU=1` selects the best device, `GPU=NAME` one by a part of its name. Otherwise the Vulkan loader only
//! sees Mesa's software driver, from before `main`, so that the test program and everything it starts use
//! that driver. A reader's `cargo run` is not affected.
//!
//! Linking this crate is enough; a test program that needs nothing else from it writes `use device as _;`.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// The variable that names the drivers to the loader. `VK_DRIVER_FILES` does the same and takes precedence,
/// so a test that brings a driver, and `--compile-for`, need not know this one.
pub const VARIABLE: &str = "VK_ICD_FILENAMES";

/// A manifest that no driver has, for a machine without the software driver, so that no other driver is used
/// instead.
const NONE: &str = "no-software-driver-for-tests";

/// Called by the system before `main`.
#[used]
#[cfg_attr(any(target_os = "linux", target_os = "android"), unsafe(link_section = ".init_array"))]
#[cfg_attr(target_vendor = "apple", unsafe(link_section = "__DATA,__mod_init_func"))]
#[cfg_attr(windows, unsafe(link_section = ".CRT$XCU"))]
static BEFORE_MAIN: extern "C" fn() = choose;

extern "C" fn choose() {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    // An explicit choice of drivers is respected, including that of a test that starts itself again.
    if asked().is_some() || is_set(VARIABLE) || is_set("VK_DRIVER_FILES") {
        return;
    }
    let manifest = manifest().unwrap_or_else(|| NONE.into());
    // SAFETY: before `main` there is only one thread, and no other code reads or writes the environment.
    unsafe { std::env::set_var(VARIABLE, manifest) };
}

/// Returns whether tests run on the software driver and in its own arithmetic, where they demand bitwise
/// equality even if Vulkan promises less. Pipelines changed by `ARITHMETIC_SEED` count as another device's.
pub fn is_software() -> bool {
    asked().is_none() && std::env::var_os("ARITHMETIC_SEED").is_none()
}

/// The value of `GPU`, if it selects a device other than the software driver.
pub fn asked() -> Option<&'static str> {
    static ASKED: LazyLock<Option<String>> =
        LazyLock::new(|| std::env::var("GPU").ok().filter(|gpu| !["", "0"].contains(&&**gpu)));
    ASKED.as_deref()
}

/// The manifest of Mesa's software driver, in the folders the loader searches.
pub fn manifest() -> Option<PathBuf> {
    let or = |name: &str, usual: &str| match std::env::var(name) {
        Ok(folders) if !folders.is_empty() => folders,
        _ => usual.to_owned(),
    };
    let own = std::env::var("HOME").map_or(String::new(), |home| format!("{home}/.local/share"));
    let folders = [
        or("XDG_CONFIG_DIRS", "/etc/xdg"),
        "/etc".to_owned(),
        or("XDG_DATA_HOME", &own),
        or("XDG_DATA_DIRS", "/usr/local/share:/usr/share"),
    ];
    let folders: Vec<PathBuf> = folders.iter().flat_map(std::env::split_paths).collect();
    manifest_in(&folders)
}

/// The manifest below these folders; if there are several, that of this program's architecture.
fn manifest_in(folders: &[PathBuf]) -> Option<PathBuf> {
    let names = [format!("lvp_icd.{}.json", std::env::consts::ARCH), "lvp_icd.json".to_owned()];
    let mut files = names.iter().flat_map(|name| {
        folders.iter().map(move |folder| folder.join(Path::new("vulkan/icd.d")).join(name))
    });
    files.find(|file| file.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_several_architectures_the_program_s_own_is_taken() {
        let folder = std::env::temp_dir().join(format!("software-driver-{}", std::process::id()));
        let place = folder.join("vulkan/icd.d");
        std::fs::create_dir_all(&place).unwrap();
        let found = || manifest_in(&["/nonexistent".into(), folder.clone()]);
        let write = |name: &str| std::fs::write(place.join(name), "{}").unwrap();
        for other in ["radeon_icd.json", "lvp_icd.none.json"] {
            write(other);
            assert_eq!(found(), None);
        }
        for name in ["lvp_icd.json", &format!("lvp_icd.{}.json", std::env::consts::ARCH)] {
            write(name);
            assert_eq!(found(), Some(place.join(name)));
        }
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_choice_was_made_before_this() {
        let chosen = std::env::var_os(VARIABLE).or(std::env::var_os("VK_DRIVER_FILES"));
        assert!(chosen.is_some() || asked().is_some());
    }
}
