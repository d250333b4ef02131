//! Environments in which a process finds a card that is not installed.
//!
//! Mesa's shims replace the kernel's driver: preloaded, each shows Mesa's own Vulkan driver a card. Debian's package
//! `mesa-drm-shim` has the one for AMD; `tests/intel/build` builds the one for Intel.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};
use common::files::cache;

use super::family::Maker;

/// Environment variables with their values.
pub type Variables = Vec<(&'static str, OsString)>;

/// The shim for AMD, which the system's linker finds wherever it is installed.
const AMD_SHIM: &str = "libamdgpu_noop_drm_shim.so";
/// The shim for Intel, in the user's folder of caches.
const INTEL_SHIM: &str = "libintel_noop_drm_shim.so";

/// Environment variables that provide this card to a child process, the best first: Mesa's shim, and for AMD also
/// RADV's own null hardware.
///
/// # Errors
/// If Intel's shim has not been built.
pub fn ways(card: &str) -> Result<Vec<Variables>> {
    let preloaded =
        |shim: OsString| ("LD_PRELOAD", preloaded(shim, std::env::var_os("LD_PRELOAD")));
    Ok(match Maker::of(card) {
        Maker::Amd => vec![
            vec![preloaded(AMD_SHIM.into()), ("AMDGPU_GPU_ID", card.into())],
            vec![("RADV_FORCE_FAMILY", card.into())],
        ],
        Maker::Intel => {
            vec![vec![preloaded(intel_shim()?.into()), ("INTEL_STUB_GPU_PLATFORM", card.into())]]
        }
    })
}

/// A shim, followed by what was preloaded before except another shim: one process has one kernel.
fn preloaded(mut shim: OsString, before: Option<OsString>) -> OsString {
    let before = before.unwrap_or_default();
    let before = before.to_string_lossy();
    for other in before.split([':', ' ']) {
        if !other.is_empty() && !other.ends_with("_noop_drm_shim.so") {
            shim.push(":");
            shim.push(other);
        }
    }
    shim
}

/// The reason why there are no cards of Intel's to compile for; `None` if there are.
pub fn why_no_intel() -> Option<String> {
    let found = intel_shim().and_then(|_| manifest("dg2"));
    found.err().map(|error| error.to_string())
}

/// The library that shows Intel's cards.
fn intel_shim() -> Result<PathBuf> {
    let shim = cache::users_own("intel").map(|folder| folder.join(INTEL_SHIM));
    let shim = shim.filter(|shim| shim.exists());
    let Some(shim) = shim else {
        bail!(
            "what stands in for Intel's cards is not built: run tests/intel/build --install, once"
        )
    };
    // The linker takes these for the ends of names.
    if shim.as_os_str().to_string_lossy().contains([':', ' ']) {
        bail!(
            "'{}' cannot be preloaded: its path has a blank or a colon; set XDG_CACHE_HOME",
            shim.display()
        );
    }
    Ok(shim)
}

/// The manifest with which the loader finds Mesa's driver for this card.
///
/// # Errors
/// If there is none; says what to install.
pub fn manifest(card: &str) -> Result<PathBuf> {
    // The loader's own search path: the variable replaces the usual folders.
    let shared = std::env::var("XDG_DATA_DIRS").unwrap_or_default();
    let shared = if shared.is_empty() { "/usr/local/share:/usr/share" } else { &shared };
    let folders = ["/etc"].into_iter();
    let folders = folders.chain(shared.split(':').filter(|folder| !folder.is_empty()));
    manifest_in(folders, Maker::of(card))
}

/// The manifest in one of these configuration and shared-data folders.
fn manifest_in<'a>(folders: impl Iterator<Item = &'a str>, maker: Maker) -> Result<PathBuf> {
    let mut manifests: Vec<PathBuf> = folders
        .filter_map(|folder| Path::new(folder).join("vulkan/icd.d").read_dir().ok())
        .flat_map(|entries| entries.flatten().map(|entry| entry.path()))
        .collect();
    let (stem, driver, arch) = match maker {
        Maker::Amd => ("radeon_icd", "AMD (RADV)", "vulkan-radeon"),
        Maker::Intel => ("intel_icd", "Intel (ANV)", "vulkan-intel"),
    };
    // With several architectures there is one for each: radeon_icd.x86_64.json.
    let fit = format!("{stem}.{}.json", std::env::consts::ARCH);
    manifests.sort();
    let named = |wanted: &str| {
        manifests.iter().find(|path| path.file_name() == Some(OsStr::new(wanted))).cloned()
    };
    named(&fit).or_else(|| named(&format!("{stem}.json"))).ok_or_else(|| {
        anyhow!(
            "figures of a GPU's compiler need Mesa's Vulkan driver for {driver}, which is not installed: \
             run ./setup, or install mesa-vulkan-drivers on Debian, Ubuntu or Fedora, {arch} on Arch"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manifest_is_found_where_a_loader_looks_and_a_missing_one_says_what_to_install() {
        let folder = std::env::temp_dir().join(format!("manifests-{}", std::process::id()));
        let place = folder.join("vulkan/icd.d");
        std::fs::create_dir_all(&place).unwrap();
        let shared = || ["/nonexistent", folder.to_str().unwrap()].into_iter();
        let write = |name: &str| std::fs::write(place.join(name), "{}").unwrap();
        let found =
            |maker| manifest_in(shared(), maker).map(|path| path.file_name().unwrap().to_owned());
        write("lvp_icd.json");
        for maker in [Maker::Amd, Maker::Intel] {
            let refused = found(maker).unwrap_err().to_string();
            assert!(refused.contains("install mesa-vulkan-drivers"), "{refused}");
        }
        write("radeon_icd.json");
        write("intel_icd.json");
        assert_eq!(found(Maker::Amd).unwrap(), "radeon_icd.json");
        assert_eq!(found(Maker::Intel).unwrap(), "intel_icd.json");
        // With several architectures, this program's own.
        let own = format!("radeon_icd.{}.json", std::env::consts::ARCH);
        write("radeon_icd.i686.json");
        write(&own);
        assert_eq!(found(Maker::Amd).unwrap(), *own);
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn one_shim_takes_the_other_s_place_and_leaves_all_else_preloaded() {
        let before = "/a/libintel_noop_drm_shim.so:libjemalloc.so libamdgpu_noop_drm_shim.so";
        assert_eq!(preloaded("new.so".into(), Some(before.into())), "new.so:libjemalloc.so");
        assert_eq!(preloaded("new.so".into(), None), "new.so");
    }
}
