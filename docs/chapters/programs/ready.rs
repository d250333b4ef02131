//! Builds the programs that a command needs, if they are missing or older than their sources.

use anyhow::{Result, bail};
use common::output::complain;

use super::child;
use super::program::Programs;

/// Builds the programs that are not ready, and says so.
///
/// # Errors
/// If one does not build; Cargo has printed the reason.
pub fn build(programs: &Programs, names: &[&str]) -> Result<()> {
    let stale: Vec<&str> =
        names.iter().copied().filter(|name| programs.command(name).is_err()).collect();
    let Some(first) = stale.first() else { return Ok(()) };
    let more = match stale.len() {
        1 => String::new(),
        count => format!(" and {} more", count - 1),
    };
    complain(&format!("building {first}{more}: some minutes the first time"));
    let mut cargo = child::cargo(&programs.project.root);
    cargo.args(["build", "--quiet"]);
    cargo.args(stale.iter().flat_map(|name| ["--bin", name]));
    if programs.are_released() {
        cargo.arg("--release");
    }
    if !child::show(&mut cargo)?.success() {
        bail!("{} cannot be built", stale.join(", "));
    }
    Ok(())
}
