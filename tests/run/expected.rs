//! Values printed on pages: a test compares them with those stored in `docs/values`.
//!
//! `cargo chapters measure` runs the test with the environment variable `FIGURES`: then the values are
//! written to that folder, and the tool stores them. `cargo chapters exercise` sets `EXERCISE`: a reader's
//! changes give other values than the page's, and none is compared.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use serde_json::{Value, json};

use crate::{render, root};

/// The device used by the samples, and its driver.
static DEVICE: LazyLock<(Value, Value)> = LazyLock::new(|| {
    let mut report = render("01_foundation", "16x10", &[]).report;
    (report["device"].take(), report["driver"].take())
});

/// Compares values that are the same in every run on this device: `values` is an object of numbers, in the
/// order of the page, and `name` is such as `05_shadow_miss/acne`.
///
/// Another device than that of the stored values may give others.
pub fn hold(name: &str, values: Value) {
    let (device, driver) = &*DEVICE;
    settle(name, false, (device.clone(), driver.clone()), values);
}

/// Compares values that the test computes itself, which are the same everywhere.
pub fn hold_exact(name: &str, values: Value) {
    settle(name, false, ("host".into(), "".into()), values);
}

/// Compares the figures of a GPU's compiler, which are the same in every run, for a generation such as
/// `RDNA3`.
pub fn hold_compiled(name: &str, compiler: &str, generation: &str, values: Value) {
    hold_compiled_by("RADV", name, compiler, generation, values);
}

/// The same of another driver's compiler.
pub fn hold_compiled_by(driver: &str, name: &str, compiler: &str, generation: &str, values: Value) {
    settle(name, false, (driver.into(), format!("{compiler}, {generation}").into()), values);
}

/// Returns whether this device and its driver are those of stored values.
///
/// For claims about one driver in matters that Vulkan leaves open: a test says why next to it, and only
/// claims what Vulkan promises for all others.
pub fn are_of_this_driver(name: &str) -> bool {
    let stored = stored(name);
    let (device, driver) = &*DEVICE;
    stored["device"] == *device && stored["driver"] == *driver
}

/// Writes values that differ from run to run, such as times, without a comparison.
pub fn give_timed(name: &str, values: Value) {
    if std::env::var_os("FIGURES").is_some() {
        let (device, driver) = &*DEVICE;
        settle(name, true, (device.clone(), driver.clone()), values);
    }
}

fn settle(name: &str, timed: bool, (device, driver): (Value, Value), values: Value) {
    let given = json!({ "timed": timed, "device": device, "driver": driver, "values": values });
    let numbers = values.as_object().expect("figures are an object");
    assert!(numbers.values().all(Value::is_number), "{name}: not all are numbers: {values}");
    if let Some(folder) = std::env::var_os("FIGURES") {
        let file = Path::new(&folder).join(format!("{name}.json"));
        std::fs::create_dir_all(file.parent().expect("a page's folder")).expect("a folder");
        std::fs::write(&file, given.to_string()).expect("figures can be written");
        return;
    }
    if std::env::var_os("EXERCISE").is_some() {
        return;
    }
    let stored = stored(name);
    let others = [&stored["device"], &stored["driver"]] != [&given["device"], &given["driver"]];
    if others {
        println!("{name}: stored of {}, {}; here {values}", stored["device"], stored["driver"]);
        return;
    }
    let (file, renew) = (file(name), renew(name));
    assert_eq!(stored["values"], values, "{name} is not what {} has; {renew}", file.display());
}

/// The file with the stored values of a measurement's page.
fn file(name: &str) -> PathBuf {
    let page = name.split('/').next().unwrap_or(name);
    root().join(format!("docs/values/{page}.json"))
}

fn renew(name: &str) -> String {
    format!("run: cargo chapters measure {name}")
}

/// A stored measurement: its values, device and driver.
///
/// # Panics
/// If it is not stored.
pub fn stored(name: &str) -> Value {
    let (file, renew) = (file(name), renew(name));
    let text = std::fs::read_to_string(&file)
        .unwrap_or_else(|error| panic!("no {}: {error}; {renew}", file.display()));
    let mut page: Value = serde_json::from_str(&text)
        .unwrap_or_else(|error| panic!("{} is damaged: {error}; {renew}", file.display()));
    let own = name.rsplit('/').next().unwrap_or(name);
    let record = page.get_mut(own).map(Value::take);
    record.unwrap_or_else(|| panic!("{} has no {own}; {renew}", file.display()))
}
