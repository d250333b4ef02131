//! The times of the tests: each test program adds a line at its end.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::parent_id;
use std::sync::Once;

/// From the first call on, this program prints the processor time of itself and its children at its end.
pub fn keep() {
    static ONCE: Once = Once::new();
    // SAFETY: `tell` is a function of this program, which stays loaded to its end.
    ONCE.call_once(|| unsafe {
        libc::atexit(tell);
    });
}

/// Adds this program to those run by the same Cargo, and prints them all; the last line is the sum.
extern "C" fn tell() {
    let Some((name, seconds)) = name().zip(seconds()) else { return };
    let folder = crate::root().join("target/spent");
    let file = folder.join(format!("{}.json", parent_id()));
    let mut all: BTreeMap<String, f64> = fs::read(&file)
        .ok()
        .and_then(|text| serde_json::from_slice(&text).ok())
        .unwrap_or_default();
    all.insert(name, seconds);
    if let Ok(text) = serde_json::to_vec(&all) {
        // No test depends on the file; without it there is no sum.
        let _ = fs::create_dir_all(&folder).and_then(|()| fs::write(&file, text));
    }
    let mut parts: Vec<_> = all.iter().collect();
    parts.sort_by(|one, other| other.1.total_cmp(one.1));
    let list: Vec<_> = parts.iter().map(|(name, seconds)| format!("{name} {seconds:.0}")).collect();
    println!("seconds of processors: {:.0} ({})", all.values().sum::<f64>(), list.join(", "));
}

/// The test program's name, without Cargo's suffix.
fn name() -> Option<String> {
    let file = std::env::current_exe().ok()?;
    let stem = file.file_stem()?.to_str()?;
    Some(stem.rsplit_once('-').map_or(stem, |(name, _)| name).to_owned())
}

/// The processor time of this process and the children it has waited for, in seconds.
fn seconds() -> Option<f64> {
    let of = |who| {
        // SAFETY: all zeros is a value of this structure of numbers.
        let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
        // SAFETY: the call writes to the given place.
        let told = unsafe { libc::getrusage(who, &mut usage) } == 0;
        let seconds = |time: libc::timeval| time.tv_sec as f64 + time.tv_usec as f64 * 1e-6;
        told.then(|| seconds(usage.ru_utime) + seconds(usage.ru_stime))
    };
    Some(of(libc::RUSAGE_SELF)? + of(libc::RUSAGE_CHILDREN)?)
}
