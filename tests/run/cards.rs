//! Stand-ins for Radeon and Intel cards with their complete drivers: Mesa's RADV and ANV over Mesa's drm-shim.
//!
//! Limits, memory, images, builds and traces are the card's. Submitted work is never executed, so pictures
//! are empty and are compared with nothing.

use std::ffi::OsString;
use std::os::unix::process::CommandExt;
use std::process::{Command, Output};

use common::exit::child::bound_memory;
use instruments::compile_for::{Maker, Variables, manifest, ways};
use serde_json::Value;

use crate::{command, device};

/// Memory of a program on an Intel card: it reads counts that nothing has written, and might believe them.
const MOST_BYTES: u64 = 16 << 30;

/// Lines that RADV and the shim print to standard error by themselves.
const NOISE: [&str; 3] =
    ["DRM_IOCTL_GET_CAP: unhandled", "radv/amdgpu:", "WARNING: radv is not a conformant"];

/// The variable that names drivers to the loader with the highest precedence.
const DRIVERS: &str = "VK_DRIVER_FILES";

/// A card, by the shim's name for it.
#[derive(Clone, Copy, Debug)]
pub struct Card(pub &'static str);

impl Card {
    /// The environment in which a program finds only this card; `None`, with a message, if there is no shim.
    pub fn environment(self) -> Option<Variables> {
        match self.variables() {
            Ok(variables) => Some(variables),
            Err(why) => {
                println!("not tried on {}: {why}", self.0);
                None
            }
        }
    }

    fn variables(self) -> Result<Variables, String> {
        let mut variables = ways(self.0).map_err(|error| error.to_string())?.swap_remove(0);
        // The dynamic linker itself reports whether it finds the library.
        let linker = Command::new("true").envs(variables.clone()).output().expect("`true` starts");
        if !linker.stderr.is_empty() {
            return Err("no card can be had without mesa-drm-shim: run ./setup".to_owned());
        }
        variables.push((DRIVERS, manifest(self.0).map_err(|error| error.to_string())?.into()));
        Ok(variables)
    }

    /// Tests whether a device of this name is this card.
    pub fn is(self, device: &str) -> bool {
        Maker::of(self.0).is(self.0, device)
    }

    /// The same with the software driver in addition, as on a machine with both.
    pub fn beside_software(self) -> Option<Variables> {
        let mut variables = self.environment()?;
        let radv = &mut variables.last_mut().expect("the driver's manifest").1;
        let folder = std::path::Path::new(radv).parent().expect("it lies in a folder").to_owned();
        let name = |file: &OsString| file.to_string_lossy().starts_with("lvp_icd.");
        let mut files = folder.read_dir().expect("a folder of manifests").map(|file| file.unwrap());
        let software = files.find(|file| name(&file.file_name())).expect("run ./setup").path();
        let both = [std::path::PathBuf::from(&*radv), software];
        *radv = std::env::join_paths(both).expect("plain names");
        Some(variables)
    }

    /// Makes a command, and all its children, find this card and every installed driver, as a fresh `cargo
    /// test` with this `GPU` would; false, with a message, if there is no shim.
    pub fn found_by(self, command: &mut Command, gpu: Option<&str>) -> bool {
        let Some(variables) = self.environment() else { return false };
        let drivers = [device::VARIABLE, DRIVERS];
        command.envs(variables.into_iter().filter(|(name, _)| !drivers.contains(name)));
        for name in drivers {
            command.env_remove(name);
        }
        command.env_remove("GPU").envs(gpu.map(|gpu| ("GPU", gpu)));
        true
    }

    /// Returns whether the installed shim knows the card; prints a message if it does not.
    pub fn is_known(self) -> bool {
        let Some(mut command) = self.command("02_basic") else { return false };
        let output = command.arg("--list-devices").output().expect("it starts");
        let known = !String::from_utf8_lossy(&output.stderr).contains("Failed to find amdgpu GPU");
        if !known {
            println!("not tried: the shim that is here has no {}", self.0);
        }
        known
    }

    /// A sample's command with only this card.
    pub fn command(self, name: &str) -> Option<Command> {
        let mut command = command(name);
        command.envs(self.environment()?);
        if Maker::of(self.0) == Maker::Intel {
            bound(&mut command);
        }
        Some(command)
    }
}

/// Limits the memory of a program.
fn bound(command: &mut Command) {
    // SAFETY: between fork and exec the child makes this one call, which is allowed there.
    unsafe {
        command.pre_exec(|| {
            bound_memory(MOST_BYTES);
            Ok(())
        });
    }
}

/// A program's standard error, without the lines of the driver and the shim.
pub fn said(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr);
    let own = text.lines().filter(|line| NOISE.iter().all(|noise| !line.starts_with(noise)));
    own.collect::<Vec<_>>().join("\n")
}

/// The report of a run with `--report -`, which must have succeeded without messages.
#[track_caller]
pub fn report(what: &str, output: &Output) -> Value {
    assert!(output.status.success(), "{what}: {}", said(output));
    assert_eq!(said(output), "", "{what} is not silent");
    let report: Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    assert_eq!(report["validation_messages"], serde_json::json!([]), "{what}");
    report
}

/// The exit code and the message of a run that must have failed with one line.
#[track_caller]
pub fn refusal(output: &Output) -> (i32, String) {
    let line = said(output);
    assert!(!output.status.success(), "accepted");
    assert_eq!(line.lines().count(), 1, "more than one line: {line}");
    assert!(line.starts_with("error: "), "{line}");
    (output.status.code().unwrap_or_else(|| panic!("killed: {line}")), line)
}
