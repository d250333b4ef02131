//! The samples as built programs: they lie beside this one, and tell their controls themselves.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::thread;
use std::time::SystemTime;

use anyhow::{Context, Result};

/// A control, as `--list-controls` prints it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Control {
    /// Its name.
    pub name: String,
    /// Its kind, such as `number`.
    pub kind: String,
    /// What it may be.
    pub possible: String,
    /// What it is at the start.
    pub value: String,
}

/// A sample's controls.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Controls(pub Vec<Control>);

impl Controls {
    /// Reads what `--list-controls` printed.
    pub fn parse(printed: &str) -> Self {
        let control = |line: &str| {
            let fields: Vec<&str> = line.trim_end_matches('\r').split('\t').collect();
            let [name, kind, possible, value] = fields[..] else { return None };
            let [name, kind, possible, value] = [name, kind, possible, value].map(str::to_owned);
            Some(Control { name, kind, possible, value })
        };
        Self(printed.lines().filter_map(control).collect())
    }

    /// The table on the page.
    pub fn table(&self) -> String {
        if self.0.is_empty() {
            return "This chapter has no controls.\n".to_owned();
        }
        let mut table = "| Name | Kind | Values | Default |\n|---|---|---|---|\n".to_owned();
        for Control { name, kind, possible, value } in &self.0 {
            let [name, kind, possible, value] =
                [name, kind, possible, value].map(|text| text.replace('|', "\\|"));
            table.push_str(&format!("| `{name}` | {kind} | {possible} | `{value}` |\n"));
        }
        table
    }

    /// Why a control cannot be set to a value, if it cannot.
    pub fn refuse(&self, name: &str, value: &str) -> Option<String> {
        let Some(control) = self.0.iter().find(|control| control.name == name) else {
            let names: Vec<&str> = self.0.iter().map(|control| &*control.name).collect();
            return Some(format!("there is no control '{name}', only {}", names.join(", ")));
        };
        let possible = match &*control.kind {
            "choice" => control.possible.split(", ").any(|option| option == value),
            "number" | "whole number" => {
                let ends = control.possible.split_once(" to ");
                let number = |text: &str| text.parse::<f64>().ok();
                let ends = ends.and_then(|(low, high)| Some(number(low)?..=number(high)?));
                ends.is_none_or(|range| number(value).is_some_and(|value| range.contains(&value)))
            }
            _ => true,
        };
        let kind = if control.kind == "whole number" { "a whole number from " } else { "" };
        let what = || format!("'{name}' cannot be '{value}': it takes {kind}{}", control.possible);
        (!possible).then(what)
    }
}

/// The samples' programs.
pub struct Programs {
    folder: PathBuf,
    root: PathBuf,
    known: Mutex<BTreeMap<String, Result<Controls, String>>>,
}

impl Programs {
    /// The programs beside this one, run in the project at `root`.
    ///
    /// # Errors
    /// If the system does not say where this one is.
    pub fn beside_this(root: &Path) -> Result<Self> {
        let this = std::env::current_exe().context("cannot tell where this program lies")?;
        let folder = this.parent().context("this program lies in no folder")?.to_owned();
        Ok(Self { folder, root: root.to_owned(), known: Mutex::default() })
    }

    /// A command that runs the program `name`.
    ///
    /// # Errors
    /// If it is missing, or older than its sources; the line says how to build it.
    pub fn command(&self, name: &str) -> Result<Command, String> {
        let file = self.folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
        let built = modified(&file).ok_or_else(|| format!("the program '{name}' is not built"))?;
        // Cargo lists a program's sources beside it.
        let listed = fs::read_to_string(self.folder.join(format!("{name}.d"))).unwrap_or_default();
        let newer = sources(&listed)
            .into_iter()
            .find(|source| modified(Path::new(source)).is_some_and(|changed| changed > built));
        if let Some(source) = newer {
            let source = Path::new(&source);
            let source = source.strip_prefix(&self.root).unwrap_or(source).display();
            return Err(format!("the program '{name}' is older than {source}"));
        }
        let mut command = Command::new(file);
        command.current_dir(&self.root).env("SHADERS", self.root.join("shaders"));
        Ok(command)
    }

    /// Where Cargo builds them: above the folder of a profile.
    pub fn target(&self) -> &Path {
        self.folder.parent().unwrap_or(&self.folder)
    }

    /// Whether they are built with `--release`.
    pub fn are_released(&self) -> bool {
        self.folder.ends_with("release")
    }

    /// Asks several programs for their controls at once; [`Programs::controls`] then answers from memory.
    pub fn ask(&self, names: &[&str]) {
        let workers = thread::available_parallelism().map_or(1, usize::from);
        let share = names.len().div_ceil(workers).max(1);
        thread::scope(|scope| {
            for names in names.chunks(share) {
                scope.spawn(move || names.iter().for_each(|name| drop(self.controls(name))));
            }
        });
    }

    /// A sample's controls.
    ///
    /// # Errors
    /// If it cannot be run, or fails.
    pub fn controls(&self, name: &str) -> Result<Controls, String> {
        let known = || self.known.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(controls) = known().get(name) {
            return controls.clone();
        }
        let controls = self.list_controls(name);
        known().insert(name.to_owned(), controls.clone());
        controls
    }

    /// Whether a sample itself takes these arguments, which may be its own or depend on one another.
    pub fn takes(&self, name: &str, arguments: &[String]) -> bool {
        let Ok(mut command) = self.command(name) else { return false };
        let output = command.args(arguments).arg("--list-controls").output();
        output.is_ok_and(|output| output.status.success())
    }

    fn list_controls(&self, name: &str) -> Result<Controls, String> {
        let output = self.command(name)?.arg("--list-controls").output();
        let output =
            output.map_err(|error| format!("the program '{name}' does not run: {error}"))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr).trim().replace('\n', " ");
            return Err(format!("{name} --list-controls failed: {said}"));
        }
        Ok(Controls::parse(&String::from_utf8_lossy(&output.stdout)))
    }
}

/// What to do about a program that cannot be run.
pub const BUILD: &str = "run: cargo build --bins";

fn modified(file: &Path) -> Option<SystemTime> {
    fs::metadata(file).and_then(|found| found.modified()).ok()
}

/// The files after the colon of a make rule, in which a blank in a name is `\ `.
fn sources(rule: &str) -> Vec<String> {
    let files = rule.split_once(": ").map_or("", |(_, files)| files.trim_end());
    let files = files.replace("\\ ", "\0");
    files.split_whitespace().map(|file| file.replace('\0', " ")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_row_a_control() {
        let controls = Controls::parse("sun\tnumber\t0 to 90\t42\nshow\tchoice\ta, b|c\ta\n");
        let table = controls.table();
        assert!(table.contains("| `sun` | number | 0 to 90 | `42` |\n"), "{table}");
        assert!(table.contains("| a, b\\|c |"), "{table}");
        assert_eq!(Controls::parse("").table(), "This chapter has no controls.\n");
    }

    #[test]
    fn settings_are_held_to_what_is_possible() {
        let controls = Controls::parse("sun\tnumber\t0 to 90\t42\nshow\tchoice\ta, b\ta\n");
        assert_eq!(controls.refuse("sun", "90"), None);
        assert_eq!(controls.refuse("show", "b"), None);
        for (name, value) in [("sun", "91"), ("sun", "x"), ("show", "c"), ("moon", "1")] {
            assert!(controls.refuse(name, value).is_some(), "{name}={value}");
        }
    }

    #[test]
    fn a_rule_lists_its_sources() {
        assert_eq!(sources("/t/a: /s/b\\ c.rs /s/d.rs\n"), ["/s/b c.rs", "/s/d.rs"]);
        assert!(sources("").is_empty());
    }
}
