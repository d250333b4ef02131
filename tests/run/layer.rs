//! Layers between a program and the driver, used only by tests.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

use crate::command;

/// A layer, registered with the Vulkan loader for as long as this lives.
pub struct Layer {
    folder: TempDir,
    layers: String,
    /// True if the loader calls it before all others.
    first: bool,
    variables: Vec<(&'static str, OsString)>,
}

impl Layer {
    /// The narrowest device: everything optional is hidden. `faults` adds faults, in the words of
    /// `tests/layer/minimum_limits`.
    pub fn minimum_limits(faults: &str) -> Self {
        // Validation checks the program against the narrow device, without being requested.
        let layers = format!("VK_LAYER_KHRONOS_validation:{}", minimum_limits::NAME);
        Self::new(
            "minimum_limits",
            minimum_limits::NAME,
            layers,
            false,
            vec![("MINIMUM_LIMITS", faults.into())],
        )
    }

    /// A display or a card with unusual behaviour, in the words of `tests/layer/display_faults`.
    pub fn display_faults(words: &str) -> Self {
        let layers = format!("VK_LAYER_KHRONOS_validation:{}", display_faults::NAME);
        Self::new(
            "display_faults",
            display_faults::NAME,
            layers,
            false,
            vec![("DISPLAY_FAULTS", words.into())],
        )
    }

    /// A device with opacity micromaps, in the words of `tests/samples/opacity_micromaps/layer`. The validation
    /// layer of Debian 12 does not know them.
    pub fn micromaps(words: &str) -> Self {
        let layers = micromaps::NAME.to_owned();
        Self::new("micromaps", micromaps::NAME, layers, false, vec![("MICROMAPS", words.into())])
    }

    /// A failing call: `fault` names it in the words of `tests/layer/fail_nth_call`; empty for none.
    pub fn fail_nth_call(fault: &str) -> Self {
        // Mesa's own layer, which sorts devices, crashes on some failures.
        let alone = ("NODEVICE_SELECT", "1".into());
        let variables = vec![("FAIL", fault.into()), alone];
        Self::new(
            "fail_nth_call",
            fail_nth_call::NAME,
            fail_nth_call::NAME.to_owned(),
            true,
            variables,
        )
    }

    /// The number of calls of each function by a program under a failing layer, from the file in `CALLS` of
    /// its environment; empty if the program did not finish.
    pub fn calls(file: &Path) -> BTreeMap<String, usize> {
        let told = std::fs::read_to_string(file).unwrap_or_default();
        let pair = |line: &str| {
            let (name, number) = line.split_once(' ').expect("a name and a number");
            (name.to_owned(), number.parse().expect("a number"))
        };
        told.lines().map(pair).collect()
    }

    fn new(
        library: &str,
        name: &str,
        layers: String,
        first: bool,
        variables: Vec<(&'static str, OsString)>,
    ) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let place = folder.path().join("vulkan/explicit_layer.d");
        std::fs::create_dir_all(&place).expect("a folder");
        // One program may contain the code of several layers, so each has its own entry point.
        let entry = format!("{library}_negotiate");
        let layer = serde_json::json!({
            "functions": { "vkNegotiateLoaderLayerInterfaceVersion": entry },
            "name": name,
            "type": "GLOBAL",
            "library_path": path(library),
            "api_version": "1.3.0",
            "implementation_version": "1",
            "description": "for tests alone",
        });
        let manifest = serde_json::json!({ "file_format_version": "1.2.0", "layer": layer });
        let file = place.join(library).with_extension("json");
        std::fs::write(file, manifest.to_string()).expect("a manifest");
        Self { folder, layers, first, variables }
    }

    /// A sample under this layer.
    pub fn command(&self, name: &str) -> Command {
        let mut command = command(name);
        command.envs(self.environment());
        command
    }

    /// Variables of a program's environment.
    ///
    /// Layers are called in the order in which they are named, before those that the program enables:
    /// validation sees what a failing layer passes on, and comes before a narrow device. Loaders from 1.3.234
    /// to 1.3.246 call them in the order in which they find them instead
    /// (<https://github.com/KhronosGroup/Vulkan-Loader/pull/1170>), so that order is made the same.
    pub fn environment(&self) -> Vec<(&'static str, OsString)> {
        self.environment_in(std::env::var_os("XDG_DATA_DIRS"))
    }

    /// The environment for this layer above another, without the other's validation.
    pub fn above(&self, below: &Self) -> Vec<(&'static str, OsString)> {
        let mut all = below.environment();
        let folders = all.iter().find(|(name, _)| *name == "XDG_DATA_DIRS");
        let folders = folders.map(|(_, folders)| folders.clone());
        all.extend(self.environment_in(folders));
        // A layer's own name is the last.
        let own = below.layers.rsplit(':').next().expect("a list has a last part");
        all.push(("VK_INSTANCE_LAYERS", format!("{}:{own}", self.layers).into()));
        all
    }

    fn environment_in(&self, known: Option<OsString>) -> Vec<(&'static str, OsString)> {
        let known = known.filter(|folders| !folders.is_empty());
        let known = known.unwrap_or_else(|| "/usr/local/share:/usr/share".into());
        let own = std::iter::once(PathBuf::from(self.folder.path()));
        let known = std::env::split_paths(&known);
        let folders = if self.first {
            std::env::join_paths(own.chain(known))
        } else {
            std::env::join_paths(known.chain(own))
        };
        let mut all = self.variables.clone();
        all.push(("XDG_DATA_DIRS", folders.expect("plain names")));
        all.push(("VK_INSTANCE_LAYERS", self.layers.clone().into()));
        all
    }
}

/// The layer's library, which cargo puts next to the tests that depend on it.
fn path(library: &str) -> PathBuf {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let test = std::env::current_exe().expect("a running program has a file");
    let library = test.with_file_name(format!("{DLL_PREFIX}{library}{DLL_SUFFIX}"));
    assert!(Path::new(&library).is_file(), "no {}", library.display());
    library
}

/// Runs a test of this program, possibly one with `#[ignore]`, in a child process in which every device is
/// the narrowest. For tests that call Vulkan themselves: a layer is enabled by the environment of a whole
/// process.
#[track_caller]
pub fn in_child(test: &str, faults: &str) {
    let narrow = Layer::minimum_limits(faults);
    let this = std::env::current_exe().expect("a running program has a file");
    let output = Command::new(this)
        .args(["--exact", test, "--include-ignored", "--nocapture"])
        .envs(narrow.environment())
        .env("GPU", "narrow")
        .output()
        .expect("it starts");
    let [told, errors] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success() && told.contains("1 passed"), "{told:.3000}{errors:.3000}");
}
