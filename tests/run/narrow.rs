//! The narrowest device: a layer between a program and the driver that hides all that Vulkan need not offer.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

use crate::command;

/// The layer, made known to the Vulkan loader for as long as this lives.
pub struct Narrow {
    folder: TempDir,
    faults: OsString,
}

impl Narrow {
    /// The layer; `faults` is what else is wrong with the device, in the words of `tests/gpus/narrow`.
    pub fn new(faults: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let layers = folder.path().join("vulkan/explicit_layer.d");
        std::fs::create_dir_all(&layers).expect("a folder");
        let layer = serde_json::json!({
            "name": narrow::NAME,
            "type": "GLOBAL",
            "library_path": library(),
            "api_version": "1.3.0",
            "implementation_version": "1",
            "description": "the least that Vulkan promises",
        });
        let manifest = serde_json::json!({ "file_format_version": "1.2.0", "layer": layer });
        std::fs::write(layers.join("narrow.json"), manifest.to_string()).expect("a manifest");
        Self { folder, faults: faults.into() }
    }

    /// A sample on that device. Give it `--validate`: the validation layer lies above in any case.
    pub fn command(&self, name: &str) -> Command {
        let mut command = command(name);
        command.envs(self.environment());
        command
    }

    /// What a program's environment has to hold.
    ///
    /// The order in which the layers are named is that in which they are called, and validation has to
    /// come first. Loaders from 1.3.234 to 1.3.246 call them in the order in which they find them instead
    /// (<https://github.com/KhronosGroup/Vulkan-Loader/pull/1170>), so this one is also to be found last.
    pub fn environment(&self) -> [(&'static str, OsString); 3] {
        let known = std::env::var_os("XDG_DATA_DIRS").filter(|folders| !folders.is_empty());
        let known = known.unwrap_or_else(|| "/usr/local/share:/usr/share".into());
        let own = std::iter::once(PathBuf::from(self.folder.path()));
        let folders = std::env::join_paths(std::env::split_paths(&known).chain(own));
        let layers = format!("VK_LAYER_KHRONOS_validation:{}", narrow::NAME);
        [
            ("XDG_DATA_DIRS", folders.expect("plain names")),
            ("VK_INSTANCE_LAYERS", layers.into()),
            ("NARROW", self.faults.clone()),
        ]
    }
}

/// The layer's library: cargo puts it beside the tests that depend on it.
fn library() -> PathBuf {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let test = std::env::current_exe().expect("a running program has a file");
    let library = test.with_file_name(format!("{DLL_PREFIX}narrow{DLL_SUFFIX}"));
    assert!(Path::new(&library).is_file(), "no {}", library.display());
    library
}
