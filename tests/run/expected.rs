//! Values that pages print: a test compares them with what `docs/values` has stored of them.
//!
//! `cargo chapters measure` runs the test with the environment variable `FIGURES`: then what it gave goes
//! to that folder, and the tool stores it. `cargo chapters exercise` sets `EXERCISE`: what a reader changes
//! gives other figures than the page's, and none is held.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use serde_json::{Value, json};

use crate::{render, root};

/// The device that the samples take, and its driver.
static DEVICE: LazyLock<(Value, Value)> = LazyLock::new(|| {
    let mut report = render("01_foundation", "16x10", &[]).report;
    (report["device"].take(), report["driver"].take())
});

/// Holds figures that this device gives in every run: `values` is an object of numbers, in the order in
/// which the page shows them, and `name` such as `05_shadow_miss/acne`.
///
/// Another device than that of the stored ones may give others.
pub fn hold(name: &str, values: Value) {
    let (device, driver) = &*DEVICE;
    settle(name, false, (device.clone(), driver.clone()), values);
}

/// Holds figures that the test computes by itself: they are the same everywhere.
pub fn hold_exact(name: &str, values: Value) {
    settle(name, false, ("host".into(), "".into()), values);
}

/// Holds figures of a GPU's compiler, which it gives in every run, for a generation such as `RDNA3`.
pub fn hold_compiled(name: &str, compiler: &str, generation: &str, values: Value) {
    settle(name, false, ("RADV".into(), format!("{compiler}, {generation}").into()), values);
}

/// Tests whether this device and its driver are those of stored figures.
///
/// For claims that hold of one driver, where Vulkan leaves the matter open: a test says why beside it, and
/// holds of all others only what Vulkan promises.
pub fn are_of_this_driver(name: &str) -> bool {
    let stored = stored(name);
    let (device, driver) = &*DEVICE;
    stored["device"] == *device && stored["driver"] == *driver
}

/// Gives figures that differ from run to run, such as times: nothing is compared.
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

/// The file with the values of a measurement's page.
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
