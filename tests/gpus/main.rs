//! GPUs that are not here: what their compilers make of the chapters, and the narrowest that Vulkan allows.

mod budgets;
#[cfg(target_os = "linux")]
mod narrowest;

/// The chapters that make their pipelines through the framework: all but 01.
fn chapters() -> Vec<String> {
    let folders = run::root().join("samples").read_dir().expect("samples/ can be read");
    let names = folders.map(|entry| entry.expect("an entry").file_name().into_string().unwrap());
    let mut names: Vec<String> =
        names.filter(|name| name.starts_with(|c: char| c.is_ascii_digit())).collect();
    names.retain(|name| name != "01_foundation");
    names.sort();
    names
}
